"""Texts of users in files of other programs, a function for each format; of HTML `html.escape`."""

import re


def line(text: str) -> str:
    """Write a text within a comment that is a line of a script or of a table."""
    plain = "".join(c if c.isprintable() else " " for c in text)
    plain = plain.replace('"', "'")  # three of them take the next lines into a comment of LAMMPS
    return re.sub(r"([,;]\s*)(?=[=+@-])", r"\1'", plain)  # a cell that a spreadsheet computes


def c_comment(text: str) -> str:
    """Write a text within a comment of C, in ASCII."""
    plain = "".join(c if c.isprintable() else " " for c in text.encode("ascii", "replace").decode())
    # The end of a comment may come of a backslash; of two question marks C makes other characters.
    plain = re.sub(r"\?{2,}", "?", plain.replace("\\", "/"))
    return plain.replace("*/", "* /").replace("/*", "/ *")


def cell(value: object) -> object:
    """Write a cell of a CSV table; a spreadsheet shall not compute a text."""
    computed = isinstance(value, str) and value.lstrip().startswith(("=", "+", "-", "@"))
    return f"'{value}" if computed else value
