"""The templates that ship with the program: complete, commented projects."""

import difflib
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
    """Give the first sentence of a template's first comment.

    >>> describe_template("courtyard-dome")
    'A glass dome over a courtyard of 18 m, with level rings and an open eye at its top.'
    """
    text = (template_folder() / f"{name}.toml").read_text(encoding="utf-8")
    head = takewhile(lambda line: line.startswith("# "), text.splitlines())
    return " ".join(line.removeprefix("# ") for line in head)


def near_templates(word: str) -> tuple[str, ...]:
    """Give the templates whose names have a word in them, or else a name like it; all, if none has.

    >>> near_templates("canopy")
    ('canopy-from-dxf', 'stadium-canopy')
    >>> near_templates("courtyard-doom")
    ('courtyard-dome',)
    """
    names = template_names()
    found = [name for name in names if word.lower() in name]
    return tuple(found or difflib.get_close_matches(word.lower(), names, 3)) or names


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
        near = near_templates(template)
        listed = "".join(f"\n  {name}: {describe_template(name)}" for name in near)
        way_out = f"Take one of these, or see isomould new --list:{listed}"
        raise Refused("E-TEMPLATE", "--template", repr(template), f"one of {', '.join(near)}", way_out)
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
