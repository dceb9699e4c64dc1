"""Text for machines that know no letters but the plain ones."""

import unicodedata


def plain_text(text: str) -> str:
    """Give text in printable ASCII: letters lose their accents, whatever has no plain form becomes a question mark.

    >>> plain_text("Südkuppel № 2, Łódź")
    'Sudkuppel No 2, ?odz'
    """
    parts = unicodedata.normalize("NFKD", text)
    bare = "".join(character for character in parts if not unicodedata.combining(character))
    return bare.encode("ascii", "replace").decode()
