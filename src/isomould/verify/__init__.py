"""The certificate: proves a delivered folder from its files, with readers and formulas of its own."""

from isomould.verify.certificate import Certificate, Check
from isomould.verify.folder import verify_folder, verify_page
from isomould.verify.nested import verify_nest

__all__ = ["Certificate", "Check", "verify_folder", "verify_nest", "verify_page"]
