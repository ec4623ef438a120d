"""Exact engines: quotient algebras, parametrisations, lifting, linear factors, an oracle."""

from exactfold.lazy import attached

__getattr__, __dir__ = attached(__name__)
