"""The certificate: proves a delivered folder from its files, with readers and formulas of its own.

The proofs are loaded when they are asked for (PEP 562): what a certificate is can be known without them.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from isomould.verify.certificate import Certificate, Check

if TYPE_CHECKING:
    from isomould.verify.folder import verify_folder, verify_page
    from isomould.verify.nested import verify_nest

_HOMES = {"verify_folder": "folder", "verify_page": "folder", "verify_nest": "nested"}

__all__ = ["Certificate", "Check", "verify_folder", "verify_nest", "verify_page"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        message = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(message)
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
