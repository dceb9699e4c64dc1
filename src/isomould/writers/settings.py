"""The `[deliver]` table: what is written, and under which layer names."""

from collections import Counter
from collections.abc import Mapping
from typing import Annotated, Literal, get_args

from pydantic import AfterValidator, Field

from isomould.parts.settings import Along
from isomould.settings import Settings
from isomould.units import Flag, Length, MassUnit

LayerName = Annotated[str, Field(pattern=r"^[A-Za-z0-9_$-]{1,31}$")]
Layer = Literal["CUT", "CUT_INNER", "DRILL", "ENGRAVE", "SCORE", "SHEET", "INFO"]


_TAKEN = frozenset(("0", "DEFPOINTS"))
"""Layers that every DXF file has; nothing on the second is plotted."""


def layer_names(layers: Mapping[Layer, str]) -> dict[Layer, str]:
    """Complete the shop's names of layers with ours.

    >>> layer_names({"CUT": "SCHNITT"})["CUT"], layer_names({})["DRILL"]
    ('SCHNITT', 'DRILL')
    """
    return {layer: layers.get(layer, layer) for layer in get_args(Layer)}


def _names_apart(layers: dict[Layer, str]) -> dict[Layer, str]:
    """Hold the layers to a name of its own each: two processes never share a layer."""
    names = [name.upper() for name in layer_names(layers).values()]
    taken = sorted(_TAKEN & set(names))
    if taken:
        message = f"{' and '.join(taken)} is a layer of DXF itself; names of your own"
        raise ValueError(message)
    twins = [name for name, count in Counter(names).items() if count > 1]
    if twins:
        message = f"two layers are called {twins[0]}; a name of its own for every layer, our own names among them"
        raise ValueError(message)
    return layers


Version = Literal["R2010", "R12"]


def _with_ours(versions: tuple[Version, ...]) -> tuple[Version, ...]:
    if "R2010" not in versions or len(set(versions)) < len(versions):
        message = 'R2010 is always written, once; R12 beside it on request: ["R2010", "R12"]'
        raise ValueError(message)
    return versions


def _apart(distance: float) -> float:
    if distance == 0:
        message = "must be other than 0: the layers would lie in one place"
        raise ValueError(message)
    return distance


class DoubleLayerSettings(Settings):
    """A second layer with members parallel to the first one's: what keeps the distance, and which side it lies on."""

    offset: Literal["edge", "face", "vertex"]
    distance: Annotated[Length, AfterValidator(_apart)]
    """Positive to the outside."""


class DeliverSettings(Settings):
    """The `[deliver]` table."""

    layers: Annotated[dict[Layer, LayerName], AfterValidator(_names_apart)] = Field(default_factory=dict[Layer, str])
    """Other names for the layers of the machine DXF."""
    dxf: Annotated[tuple[Version, ...], AfterValidator(_with_ours)] = ("R2010",)
    """Versions of the machine DXF; R12 twins lie in `r12/`."""
    nc1_mass: MassUnit | None = None
    """What line 15 of NC1 files holds; by default kg/m for members and kg/m² for plates."""
    labels: Flag = False
    """A4 sheets of labels with QR codes, one for every piece."""
    strips: tuple[Along, ...] = ()
    """Strips to unroll: between neighbouring generatrices, between neighbouring parallels."""
    solids: tuple[Literal["members", "panels"], ...] = ()
    """Parts to write as solids, 3MF and STL, beside the nodes."""
    double_layer: DoubleLayerSettings | None = None
    compare: Flag = False
    """Schedule the same surface as every mesh family."""
    drawings: Flag = True
    """Whether shop drawings are written."""
    paper: Literal["auto", "A4", "A3"] = "auto"
    """Of the shop drawings; by default A4 where parts are drawn at 1:20 or larger, else A3."""
    parquet: Flag = False
    """Write every table as Apache Parquet too."""

    def mass_unit(self, kind: Literal["bar", "plate"]) -> MassUnit:
        """Give what line 15 of NC1 files holds: as asked for, or as exporters write it for bars and for plates."""
        return self.nc1_mass or ("kg/m" if kind == "bar" else "kg/m2")
