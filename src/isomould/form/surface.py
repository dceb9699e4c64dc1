"""The surface as a product of rail and profile, and what its edges must not do (geometry §3, §4)."""

from dataclasses import dataclass

import numpy as np

from isomould.arrays import Floats, read_only
from isomould.errors import Refused
from isomould.form.profile import Profile
from isomould.form.rail import Rail
from isomould.ties import FINE, first_largest


@dataclass(frozen=True, eq=False)
class Surface:
    """A discrete Monge surface: `V = R + d·A + z·C` and its offset field `O = a·A + b·C`.

    Attributes
    ----------
    rail, profile
        The two factors.
    V : (m, n, 3) float, mm
        Nodes; index i counts parallels, j generatrices.
    """

    rail: Rail
    profile: Profile
    V: Floats

    def __post_init__(self) -> None:
        read_only(self.V)


def make_surface(rail: Rail, profile: Profile) -> Surface:
    """Multiply rail and profile out; no loop, one output array and one of its size (geometry §3)."""
    nodes = np.multiply.outer(profile.d, rail.A)
    nodes += np.multiply.outer(profile.z, rail.C)
    nodes += rail.R
    return Surface(rail, profile, nodes)


def node_axes(surface: Surface) -> Floats:
    """Unit node axes (m, n, 3): the direction of the offset field (geometry §4)."""
    rail, profile = surface.rail, surface.profile
    axes = np.multiply.outer(profile.a, rail.A)
    axes += np.multiply.outer(profile.b, rail.C)
    axes /= np.linalg.norm(axes, axis=2, keepdims=True)
    return axes


def parallel_lengths(rail: Rail, offsets: Floats) -> Floats:
    """Signed lengths (m, e) mm of the edges of parallels at offsets (m, 2): d and z (geometry §3).

    `L' = L + d (A[j+1] − A[j])·e + z (C[j+1] − C[j])·e`; on a planar rail `L + d (tan(α_j/2) + tan(α_{j+1}/2))`.
    """
    return rail.lengths + offsets @ rail.growth.T


def refuse_flips(surface: Surface, depth: float, min_member: float) -> None:
    """Refuse edges that flip or fall below `min_member` on the mid layer, or flip at ±depth/2 (C6, C7).

    Raises
    ------
    Refused
        Naming parallel, strip, offset and the largest admissible offset.
    """
    profile = surface.profile
    place, field = np.column_stack([profile.d, profile.z]), np.column_stack([profile.a, profile.b])
    _refuse_parallels(surface.rail, place, min_member)
    for side in (-depth / 2, depth / 2):
        _refuse_parallels(surface.rail, place + side * field, 0.0)
        _refuse_generatrices(profile, side)
    _refuse_short_generatrices(profile, min_member)


def _refuse_parallels(rail: Rail, offsets: Floats, limit: float) -> None:
    lengths = parallel_lengths(rail, offsets)
    if lengths.min() > limit:
        return
    i, j = np.unravel_index(int(np.argmin(lengths)), lengths.shape)
    away = _away(rail.growth[j])
    growth, offset = float(rail.growth[j] @ away), float(offsets[i] @ away)
    admissible = (limit - rail.lengths[j]) / growth if growth else rail.lengths[j]
    flips = lengths[i, j] <= 0
    raise Refused(
        "E-SURFACE-FLIP" if flips else "E-SURFACE-SHORT",
        "generatrix.curve" if flips else "tolerances.min_member",
        f"parallel {i} {'flips' if flips else 'shrinks'} to {lengths[i, j]:.3f} mm in strip {j}: its offset from the "
        f"rail is {offset:.3f} mm{_said(away)}",
        f"{'at least' if growth > 0 else 'at most'} {admissible:.3f} mm there for members of {limit:g} mm",
        "Move the generatrix (generatrix.origin), flatten the rail, or divide it more coarsely.",
    )


def _away(growth: Floats) -> Floats:
    """Unit direction (2,) in (d, z), rather outside than inside, in which edges grow or shrink most."""
    size = float(np.hypot(*growth))
    return growth / size * np.sign(growth[first_largest(np.abs(growth), FINE * size)]) if size else np.array([1.0, 0.0])


def _said(away: Floats) -> str:
    return f" along (d, z) = ({away[0]:.3f}, {away[1]:.3f})" if away[1] else ""


def _refuse_generatrices(profile: Profile, side: float) -> None:
    lengths = np.where(profile.gap, np.inf, profile.lengths + side * stretch(profile))
    if lengths.min() > 0:
        return
    row = int(np.argmin(lengths))
    raise Refused(
        "E-SURFACE-FLIP",
        "members.section",
        f"the generatrix member of row {row} flips {abs(side):.3f} mm {'outside' if side > 0 else 'inside'} the "
        f"system line, which is {profile.lengths[row]:.3f} mm long",
        "members keep a positive length at top and bottom",
        "Use a lower section or fewer nodes on the generatrix.",
    )


def stretch(profile: Profile) -> Floats:
    """Growth (e,) of a profile edge's length per mm of offset: the signed length of its edge in O."""
    field = np.stack([profile.a, profile.b], axis=-1)
    ahead = np.roll(field, -1, axis=0) if profile.closed else field[1:]
    along = np.stack([-np.sin(profile.latitude), np.cos(profile.latitude)], axis=-1)
    return np.einsum("ij,ij->i", ahead - field[: len(ahead)], along)


def _refuse_short_generatrices(profile: Profile, limit: float) -> None:
    row = int(np.argmin(np.where(profile.gap, np.inf, profile.lengths)))
    if profile.lengths[row] > limit:
        return
    raise Refused(
        "E-SURFACE-SHORT",
        "generatrix.divide",
        f"the generatrix member of row {row} is {profile.lengths[row]:.3f} mm long",
        f"more than tolerances.min_member = {limit:g} mm",
        "Divide the generatrix into fewer nodes or lower tolerances.min_member.",
    )
