"""What parts have to share to lie on one sheet, and which sheets of the stock are for whom."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields
from typing import Literal, NoReturn, TypeVar

from isomould.errors import Refused

Grain = Literal["along", "across"]
"""How the grain of a part lies to the x axis of its outline; on a sheet it runs along the width."""

_SHOWN = 8

_Item = TypeVar("_Item")


@dataclass(frozen=True)
class Material:
    """Material, grade and thickness (mm) of a part or a sheet; blank where nothing is said."""

    material: str = ""
    grade: str = ""
    thickness: float | None = None

    @property
    def key(self) -> tuple[str, str, float | None]:
        """What is compared: words without case and doubled blanks, thickness to 0.001 mm."""
        thickness = None if self.thickness is None else round(self.thickness, 3)
        return _word(self.material), _word(self.grade), thickness

    def __str__(self) -> str:
        thickness = "" if self.thickness is None else f"{self.thickness:.12g} mm"
        return " ".join(text for text in (self.material, self.grade, thickness) if text)

    def suits(self, other: "Material") -> bool:
        """Tell whether nothing that both say differs."""
        return all(mine == its or _blank(mine) or _blank(its) for mine, its in zip(self.key, other.key, strict=True))

    def completed(self, other: "Material") -> "Material":
        """Give it with what only the other says."""
        names = [one.name for one in fields(self)]
        said = {name: getattr(self, name) for name in names}
        return Material(**{name: getattr(other, name) if _blank(mine) else mine for name, mine in said.items()})


NAMES = tuple(one.name for one in fields(Material))
"""The columns, and the keys of a stock sheet."""


def _word(text: str) -> str:
    return " ".join(text.casefold().split())


def _blank(value: str | float | None) -> bool:
    return value in ("", None)


def group(items: Iterable[_Item], of: Callable[[_Item], Material]) -> list[tuple[Material, list[_Item]]]:
    """Give the items by their material, in the order of the first."""
    found: dict[tuple[str, str, float | None], tuple[Material, list[_Item]]] = {}
    for item in items:
        found.setdefault(of(item).key, (of(item), []))[1].append(item)
    return list(found.values())


def share_out(
    wanted: Sequence[tuple[Material, int]],
    kinds: Sequence[_Item],
    of: Callable[[_Item], Material],
    noun: str,
    whose: str = "",
) -> list[list[_Item]]:
    """Give every material of a list the stock that it may be cut from.

    Parameters
    ----------
    wanted
        Materials of the list and their pieces.
    kinds, of
        The stock, and what it says of its material; what it does not say may be anything that the list has alone.
    noun, whose
        What messages call the stock, and its section.

    Raises
    ------
    Refused
        E-NEST-13, naming the materials: parts that do not say what others do, stock that may be for several, or
        none.
    """
    _refuse_half_said([material for material, _ in wanted])
    names = ", ".join(_shown(material, pieces) for material, pieces in wanted[:_SHOWN])
    for kind in kinds:
        suited = [material for material, _ in wanted if material.suits(of(kind))]
        if len(suited) > 1:
            said = f"says {of(kind)}" if str(of(kind)) else "says no material"
            found = f"{_name(kind)} {said} and may be any of {len(suited)} in the list: {names}"
            _refuse(noun, found, "stock for one of them each", _way_out(suited[0], noun))
    shares = [[kind for kind in kinds if material.suits(of(kind))] for material, _ in wanted]
    for (material, pieces), share in zip(wanted, shares, strict=True):
        if not share:
            found = f"none {whose + ' ' if whose else ''}for {_shown(material, pieces)}; the list has {names}"
            _refuse(noun, found, f"a stock {noun} for each", _way_out(material, noun))
        _refuse_choice(material, [of(kind) for kind in share], noun)
    return shares


def _name(kind: object) -> str:
    return repr(getattr(kind, "name", "") or str(getattr(kind, "section", "")))


def _shown(material: Material, pieces: int) -> str:
    return f"{str(material) or 'no material'} ({pieces} {'piece' if pieces == 1 else 'pieces'})"


def _refuse_half_said(materials: Sequence[Material]) -> None:
    """Refuse parts that do not say what others of the list do: nobody knows where they belong."""
    for name in NAMES:
        blank = [material for material in materials if _blank(getattr(material, name))]
        if blank and len(blank) < len(materials):
            others = ", ".join(sorted({str(getattr(m, name)) for m in materials if m not in blank})[:_SHOWN])
            found = f"some parts have no {name}, others have {others}"
            _refuse(name, found, f"a {name} for all or for none", "Fill in the cells.")


def _refuse_choice(material: Material, offers: Sequence[Material], noun: str) -> None:
    """Refuse stock that differs in what the parts do not say."""
    for name in NAMES:
        said = {value for offer in offers for value in [offer.key[NAMES.index(name)]] if not _blank(value)}
        if _blank(getattr(material, name)) and len(said) > 1:
            found = f"{noun}s of {' and '.join(sorted(map(str, said)))} for parts that do not say their {name}"
            _refuse(noun, found, f"one {name}, or a column of it", "Say which in the list, or give stock of one.")


def _way_out(material: Material, noun: str) -> str:
    said = " ".join(f"{name}={_text(value)}" for name in NAMES if not _blank(value := getattr(material, name)))
    size = "2500x1250" if noun == "sheet" else "SECTION=6 m"
    return f'Say it of each, such as --{noun} "{size} {said}".'


def _text(value: str | float) -> str:
    return value if isinstance(value, str) else f"{value:.12g}"


def _refuse(field: str, found: str, limit: str, way_out: str) -> NoReturn:
    raise Refused("E-NEST-13", field, found, limit, way_out)
