"""The blocks of docs/python.md, docs/python-from.md and the page on PyPI and the cells of the notebook run as they stand, one after the other."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any

import pytest
from conftest import quietly
from notebook import page

DOCS = Path(__file__).parents[2] / "docs"
NOTEBOOK = DOCS.parent / "examples" / "python" / "first_log.ipynb"


def run_blocks(name: str, least: int) -> None:
    path = DOCS / name
    text = path.read_text(encoding="utf-8")
    names: dict[str, Any] = {}
    blocks = list(re.finditer(r"^```python\n(.*?)^```$", text, flags=re.DOTALL | re.MULTILINE))
    assert len(blocks) >= least
    for block in blocks:
        # Line numbers in an error are those of the page.
        above = "\n" * text[: block.start(1)].count("\n")
        quietly(exec, compile(above + block.group(1), str(path), "exec"), names)


def test_every_block_of_the_guide_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_blocks("python.md", 10)
    assert (tmp_path / "result" / "model.toml").is_file()
    assert (tmp_path / "study" / "study.json").is_file()
    assert any(path.suffix == ".c" for path in (tmp_path / "controller").iterdir())


def test_the_page_on_pypi_runs_and_stands_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_blocks("../python/README.md", 1)
    assert any(path.suffix == ".c" for path in (tmp_path / "controller").iterdir())
    # A path of the repository is none there.
    assert "](" not in (DOCS.parent / "python" / "README.md").read_text(encoding="utf-8")


def test_what_others_write_now_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_blocks("python-from.md", 3)
    assert any(path.suffix == ".m" for path in (tmp_path / "for-matlab").rglob("*"))
    assert any("damping" in path.read_text() for path in (tmp_path / "for-mujoco").glob("*.xml"))


def test_every_cell_of_the_notebook_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    cells = [cell for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]
    assert len(cells) >= 5
    for cell in cells:
        assert not cell["outputs"], "outputs are of one machine and one day: clear them"
    shown = quietly(page, NOTEBOOK, names)
    assert names["fit"].verdict == "trustworthy"
    assert any(path.suffix == ".c" for path in (tmp_path / "controller").iterdir())
    assert shown.count("```python") == len(cells)
    # The site shows what was just run.
    if kept := os.environ.get("STICTION_NOTEBOOK_PAGE"):
        Path(kept).write_text(shown, encoding="utf-8")
