"""Shop drawings: neutral pages in paper millimetres, described once and written as PDF and as DXF."""
