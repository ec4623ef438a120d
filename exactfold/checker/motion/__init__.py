"""Certificates of motions along branches, of loops, and of motions of rigid panels."""
