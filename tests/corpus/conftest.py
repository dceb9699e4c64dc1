"""The makers of the corpus need programs that tests do not."""

collect_ignore_glob = ["make_*.py"]
