"""The digits that people see: one function for report, terminal, drawings and formats of the workbook.

Files for programs (CSV, NPZ, machines) keep the digits of their columns.
"""

from isomould.documents.numbers import format_number

_DECIMALS = {"mm": 1, "°": 2, "m²": 2, "m": 2, "kg": 1, "t": 2, "%": 1, "cm³": 1, "h": 1}
"""Decimals by unit: what can be measured, weighed or paid."""

_TONNE = 1000.0
"""From this mass (kg) on, whole kilograms."""

_RESIDUAL = 3
"""Significant digits of what is smaller than the last decimal: a residual is not nothing."""


def decimals_of(unit: str, value: float = 0.0) -> int | None:
    """Give the decimals that people see of a value; None for numbers without a unit that we know.

    >>> decimals_of("mm"), decimals_of("kg", 1234.5), decimals_of("EUR")
    (1, 0, 2)
    """
    if unit == "kg" and abs(value) >= _TONNE:
        return 0
    return _DECIMALS.get(unit, 2 if unit.partition("/")[0].isupper() else None)


def shown(value: float, unit: str = "") -> str:
    """Print a value as people read it, without its unit.

    >>> shown(1234.5678, "mm"), shown(12.3456, "kg"), shown(4321.6, "kg"), shown(0.5, "EUR"), shown(3.0)
    ('1234.6', '12.3', '4322', '0.50', '3')
    >>> shown(0.0004, "mm"), shown(2.5e-12, "mm"), shown(2.6178)
    ('0.0004', '2.5e-12', '2.62')
    """
    if isinstance(value, int) or (float(value).is_integer() and decimals_of(unit, value) is None):
        return format_number(value)
    decimals = decimals_of(unit, value)
    decimals = 2 if decimals is None else decimals
    if 0 < abs(value) < 0.5 * 10.0**-decimals:
        return f"{value:.{_RESIDUAL}g}"
    return f"{float(format_number(value, decimals)):.{decimals}f}"


def with_unit(value: float, unit: str) -> str:
    """Print a value with its unit.

    >>> with_unit(1234.5678, "mm"), with_unit(90.0, "°"), with_unit(7, "")
    ('1234.6 mm', '90.00°', '7')
    """
    return f"{shown(value, unit)}{'' if unit == '°' else ' '}{unit}".strip()


def cell_format(unit: str, value: float | None = None) -> str:
    """Give the format of a cell of a workbook, of a column's if there is no one value: what is stored stays as it is.

    >>> cell_format("mm"), cell_format("kg"), cell_format("m²", 1e-9), cell_format("", 680.0)
    ('#,##0.0', '[>=1000]#,##0;#,##0.0', '0.00E+00', '#,##0')
    """
    decimals = decimals_of(unit)
    if value is not None and decimals is None and float(value).is_integer():
        return "#,##0"
    decimals = 2 if decimals is None else decimals
    if value is not None and 0 < abs(value) < 0.5 * 10.0**-decimals:
        return "0.00E+00"
    plain = f"#,##0.{'0' * decimals}"
    return f"[>={_TONNE:.0f}]#,##0;{plain}" if unit == "kg" else plain
