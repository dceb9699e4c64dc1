"""The templates that ship with the program: complete, commented projects."""

from itertools import takewhile
from pathlib import Path

from isomould.errors import OutputFault, Refused

_INSTALLED = Path(__file__).parent / "templates"
_CHECKOUT = Path(__file__).parents[2] / "templates"


def template_folder() -> Path:
    """Give the folder of the templates: inside the installed package, or beside `src` in a checkout."""
    return _INSTALLED if _INSTALLED.is_dir() else _CHECKOUT


def template_names() -> tuple[str, ...]:
    """Give the names of all templates.

    >>> "barrel-vault" in template_names()
    True
    """
    return tuple(sorted(path.stem for path in template_folder().glob("*.toml")))


def describe_template(name: str) -> str:
    """Give what the first comment of a template says up to its first colon."""
    text = (template_folder() / f"{name}.toml").read_text(encoding="utf-8")
    comment = " ".join(line.lstrip("# ") for line in takewhile(lambda line: line.startswith("#"), text.splitlines()))
    return comment.partition(":")[0]


def copy_template(template: str, target: Path) -> tuple[Path, ...]:
    """Copy a template to a new project file, with the drawings it names beside it.

    Raises
    ------
    Refused
        If there is no such template, or a file is in the way.
    OutputFault
        If a file cannot be written.
    """
    if template not in template_names():
        listed = ", ".join(template_names())
        raise Refused("E-TEMPLATE", "--template", repr(template), f"one of {listed}", "See isomould new --list.")
    drawings = sorted(template_folder().glob(f"{template}.dxf"))
    pairs = [
        (template_folder() / f"{template}.toml", target),
        *((path, target.parent / path.name) for path in drawings),
    ]
    for _, copy in pairs:
        if copy.exists():
            raise Refused("E-NEW", str(copy), "the file exists", "a new file", "Choose another name.")
    try:
        for source, copy in pairs:
            copy.write_bytes(source.read_bytes())
    except OSError as error:
        message = f"E-NEW {error.filename}: cannot be written ({error.strerror}). Check the folder and its permissions."
        raise OutputFault(message) from error
    return tuple(copy for _, copy in pairs)
