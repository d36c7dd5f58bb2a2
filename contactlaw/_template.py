"""Templates of pages, filled by jinja2, which escapes all that is no HTML already."""

from importlib import resources

import jinja2


def _read(path: str) -> str:
    """Read a template whose path is its package, a slash, and the name of its file."""
    package, _, name = path.rpartition("/")
    return (resources.files(package) / name).read_text(encoding="utf-8")


_PAGES = jinja2.Environment(
    loader=jinja2.FunctionLoader(_read),
    undefined=jinja2.StrictUndefined,
    autoescape=True,
    trim_blocks=True,
    lstrip_blocks=True,
    keep_trailing_newline=True,
)


def template(package: str, name: str) -> jinja2.Template:
    """Read a file in the folder of a package; a template may be built on those of any package."""
    return _PAGES.get_template(f"{package}/{name}")
