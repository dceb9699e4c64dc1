"""The base of every settings type: frozen, closed to unknown keys, finite numbers only."""

from pydantic import BaseModel, ConfigDict


class Settings(BaseModel):
    """A table of the project file. Defined beside the stage that reads it; composed by `isomould.project`."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
