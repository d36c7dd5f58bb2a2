"""Pages of the site that no file of docs/ holds: those of the top folder, and the references.

mkdocs calls the functions whose names begin with `on_` (`make docs`). A file outside docs/ to which
a page links becomes a part of the site, and the link leads there. The reference of names has a page
for each module from which users import; a public name without an entry stops the build. The
reference of commands is what the parsers print for ``--help``.
"""

import argparse
import importlib
import os
import re
from pathlib import Path
from types import FunctionType

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File
from public import MODULES, public  # beside this file, in whose folder mkdocs looks

from contactlaw import cli

ROOT = Path(__file__).resolve().parents[1]
HOME = "README.md"  # the page of the repository that is the first one of the site
LINK = re.compile(r"(\]\()([^)#\s]+)([^)]*\))")
FIRST = ["ImpactModel", "Pair", "Material"]  # names with which a reference begins
DESCRIBED = (FunctionType, property, classmethod, staticmethod)


def on_config(config):
    """Complete the menu, which lists a page for each module."""
    pages = ["reference/commands.md", *(f"reference/{name}.md" for name in MODULES)]
    for entry in config.nav:
        if "Reference" in entry:
            entry["Reference"] = [
                {"Commands": page} if "commands" in page else {Path(page).stem: page} for page in pages
            ]
    return config


def on_files(files, config):
    """Add the references, and every file outside docs/ that can be reached from a page."""
    made = {"reference/commands.md": commands()}
    made |= {f"reference/{name}.md": module(name) for name in MODULES}
    for place, text in made.items():
        files.append(File.generated(config, place, content=text))
    pages = ["README.md", *(f"docs/{page.src_uri}" for page in files.documentation_pages())]
    pages += ["CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md"]
    seen = set()
    while pages:
        page = pages.pop()
        if page in seen or not (ROOT / page).is_file():
            continue
        seen.add(page)
        if not page.startswith("docs/"):
            files.append(File.generated(config, in_site(page), content=(ROOT / page).read_bytes()))
        if page.endswith(".md"):
            links = LINK.findall((ROOT / page).read_text())
            pages += [in_repository(page, target) for _, target, _ in links if "//" not in target]
    return files


def on_page_markdown(markdown, page, **_):
    """Let links lead to the places that files of the repository have in the site."""
    here = page.file.src_uri
    if here.startswith("reference/"):
        return markdown
    origin = HOME if here == "index.md" else here
    if not (ROOT / origin).exists() or (ROOT / "docs" / here).exists():
        origin = f"docs/{here}"

    def moved(link):
        before, target, after = link.groups()
        if "//" in target:
            return link[0]
        place = in_site(in_repository(origin, target))
        return before + os.path.relpath(place, Path(here).parent) + after

    return LINK.sub(moved, markdown)


def on_page_content(html, page, **_):
    """Stop where the page of a module lacks one of its names."""
    name = page.file.src_uri.removeprefix("reference/").removesuffix(".md")
    if name in MODULES:
        names = public(name)
        names += [method for one in names for method in methods(name, one)]
        missing = [one for one in names if f'id="{name}.{one}"' not in html]
        if missing:
            raise PluginError(f"the reference of {name} lacks {', '.join(missing)}")
    return html


def in_repository(page, target):
    """Path in the repository of what a link on one of its pages leads to."""
    return os.path.normpath(f"{os.path.dirname(page)}/{target}").lstrip("/")


def in_site(path):
    """Path in the site of a file of the repository."""
    return "index.md" if path == HOME else path.removeprefix("docs/")


def methods(name, one):
    """Names of what a public class has of its own and from classes of the package."""
    found = getattr(importlib.import_module(name), one)
    for part in getattr(found, "__mro__", ()):
        if part.__module__.startswith("contactlaw"):
            for method, value in vars(part).items():
                if not method.startswith("_") and isinstance(value, DESCRIBED):
                    yield f"{one}.{method}"


def module(name):
    """Write the page of a module, which mkdocstrings fills from its docstrings."""
    names = sorted(public(name), key=lambda one: FIRST.index(one) if one in FIRST else len(FIRST))
    members = "".join(f"        - {one}\n" for one in names)
    return f"# {name}\n\n::: {name}\n    options:\n      members:\n{members}"


def commands():
    """Write the page of the command line: what each parser prints for ``--help``."""
    os.environ["COLUMNS"] = "74"  # by which argparse breaks lines: the width of a page
    parts = ["# Commands\n\nWhat `--help` prints, for each command.\n"]
    waiting = [cli.parser()]
    while waiting:
        parser = waiting.pop(0)
        parts.append(f"## {parser.prog}\n\n```text\n{parser.format_help()}```\n")
        for action in parser._actions:
            if isinstance(action, argparse._SubParsersAction):
                waiting = [*action.choices.values(), *waiting]
    return "\n".join(parts)
