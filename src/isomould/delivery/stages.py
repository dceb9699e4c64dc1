"""The stages of a build in words, as those who wait for it are told."""

DESIGN = "curves, surface, parts"
SOLIDS = "node solids"
NESTING = "nesting"
PART_FILES = "part files"
SHEETS = "cut sheets"
MODELS = "models"
SCHEDULES = "schedules"
DRAWINGS = "drawings"
DRAWING_FILES = "files of drawings"
CERTIFICATE = "certificate"

BUILDING = (SOLIDS, NESTING, PART_FILES, SHEETS, MODELS, SCHEDULES, DRAWINGS, DRAWING_FILES, CERTIFICATE)
"""What is done of every shape, after the design of all."""

SCHEDULING = (SOLIDS, NESTING, SCHEDULES, CERTIFICATE)
"""What is done for schedules alone."""
