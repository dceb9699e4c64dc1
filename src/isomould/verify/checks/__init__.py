"""The checks, grouped by what they prove; each group ends with its table of rules."""
