"""Members of several grades: a section of a grade is a section of its own, in the list and in the stock."""

from collections.abc import Sequence
from dataclasses import replace

from isomould.nesting.layout import Member
from isomould.nesting.material import Material, group, share_out
from isomould.nesting.settings import BarStock, StockSettings

Graded = tuple[Member, Material]
"""A member and its grade, blank where none is said."""


def keep_grades_apart(members: Sequence[Graded], stock: StockSettings) -> tuple[tuple[Member, ...], StockSettings]:
    """Name the sections of members and bars with their grade, where a list or its stock has several.

    A section of one grade in the list, and of none in the stock, keeps its name. Names are compared without case and
    blanks, `HEA 200` is `HEA200`, and written as the stock has them.

    Raises
    ------
    Refused
        E-NEST-13 if it is not known which bar is for which grade.
    """
    members, stock = _named_alike(members, stock)
    named, bars = dict[object, str](), list[BarStock]()
    for section in dict.fromkeys(member.section for member, _ in members):
        listed = [pair for pair in members if pair[0].section == section]
        kinds = [bar for bar in stock.bars if bar.section == section]
        groups = group(listed, _grade)
        if not kinds or (len(groups) == 1 and not any(bar.grade for bar in kinds)):
            bars += kinds
            continue
        wanted = [(grade, sum(member.quantity for member, _ in some)) for grade, some in groups]
        for (grade, some), share in zip(
            groups, share_out(wanted, kinds, _grade_of_bar, "bar", f"of {section}"), strict=True
        ):
            said = [grade, *map(_grade_of_bar, share)]
            name = f"{section} {next(filter(str, said), '')}".strip()
            named.update({member.id: name for member, _ in some})
            bars += [bar.model_copy(update={"section": name}) for bar in share]
    kept = tuple(replace(member, section=named.get(member.id, member.section)) for member, _ in members)
    return kept, stock.model_copy(update={"bars": tuple(bars)})


def _named_alike(members: Sequence[Graded], stock: StockSettings) -> tuple[list[Graded], StockSettings]:
    """Give every section one name: the first that a bar has, else a member."""
    written = [*(bar.section for bar in stock.bars), *(member.section for member, _ in members)]
    names = {_compared(section): section for section in reversed(written)}
    bars = tuple(bar.model_copy(update={"section": names[_compared(bar.section)]}) for bar in stock.bars)
    alike = [(replace(member, section=names[_compared(member.section)]), grade) for member, grade in members]
    return alike, stock.model_copy(update={"bars": bars})


def _compared(section: str) -> str:
    """Give what is compared of a section: no case, no blanks, one sign between sizes (50x3, 50*3)."""
    return "".join(section.casefold().split()).translate(_SIGNS)


_SIGNS = str.maketrans("×*", "xx")


def _grade(pair: Graded) -> Material:
    return pair[1]


def _grade_of_bar(bar: BarStock) -> Material:
    return Material(grade=bar.grade)
