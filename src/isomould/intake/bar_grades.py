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

    A section of one grade in the list, and of none in the stock, keeps its name.

    Raises
    ------
    Refused
        E-NEST-13 if it is not known which bar is for which grade.
    """
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


def _grade(pair: Graded) -> Material:
    return pair[1]


def _grade_of_bar(bar: BarStock) -> Material:
    return Material(grade=bar.grade)
