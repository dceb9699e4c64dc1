"""The limit on size, held before anything large is made (failure mode J1)."""

from isomould.errors import Refused
from isomould.form.settings import FormLimits


def refuse_size(count: float, limits: FormLimits) -> None:
    """Refuse more panels, or edges of a curve, than the project allows."""
    if count > limits.max_panels:
        raise Refused(
            "E-SIZE",
            "limits.max_panels",
            f"{count:.0f} panels",
            f"{limits.max_panels}",
            "Divide the curves more coarsely, or raise the limit (about 2 kB of memory a panel).",
        )
