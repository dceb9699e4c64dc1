"""The limit on size, held before anything large is made (failure mode J1)."""

from isomould.errors import Refused
from isomould.form.settings import FormLimits


def refuse_size(count: float, limits: FormLimits, words: str = "") -> None:
    """Refuse more panels, or edges of a curve, than the project allows; `words` say what is counted: "at least"."""
    if count > limits.max_panels:
        raise Refused(
            "E-SIZE",
            "limits.max_panels",
            f"{words} {count:.3g} panels".strip() if words else f"{count:.0f} panels",
            f"{limits.max_panels}",
            "Divide the curves more coarsely, or raise the limit (about 2 kB of memory a panel).",
        )
