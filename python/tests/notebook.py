"""Runs a notebook in an empty folder and prints it as Markdown, every cell with what it shows.

python xtask/src/site/notebook.py NOTEBOOK
"""

from __future__ import annotations

import ast
import contextlib
import io
import json
import os
import sys
import tempfile
from pathlib import Path
from typing import Any


def shown(source: str, names: dict[str, Any], title: str) -> str:
    """What a cell prints, and the value of its last line."""
    tree = ast.parse(source, title)
    last = tree.body[-1] if tree.body else None
    if isinstance(last, ast.Expr):
        tree.body.pop()
    out = io.StringIO()
    # Progress goes to standard error, and changes from run to run.
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
        exec(compile(tree, title, "exec"), names)
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), title, "eval"), names)
            if value is not None:
                print(value if hasattr(value, "_repr_html_") else repr(value))
    return out.getvalue()


def page(path: Path, names: dict[str, Any]) -> str:
    """The notebook as Markdown. Files are written to the current folder, and `names` has what the cells leave."""
    parts = []
    for k, cell in enumerate(json.loads(path.read_text(encoding="utf-8"))["cells"]):
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source)
            continue
        parts.append(f"```python\n{source}\n```")
        if out := shown(source, names, f"{path.name}, cell {k + 1}"):
            parts.append(f"```text\n{out.rstrip()}\n```")
    return "\n\n".join(parts) + "\n"


def main(notebook: Path, out: Path) -> None:
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        text = page(notebook, {})
        os.chdir(before)
    out.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]))
