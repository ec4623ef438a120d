"""Exact engines: quotient algebras, parametrisations, lifting, linear factors, msolve."""
