"""Packs python/stiction and a native half that is built already into a wheel: assemble.py LIBRARY FOLDER, run by the Python
that the native half was built for.

Users and releases build the wheel with maturin. It has cargo build one package alone, which gets other features of its
dependencies than in the workspace, and so compiles the whole library once more; tests of the package need not wait for that.
"""

from __future__ import annotations

import base64
import hashlib
import sys
import sysconfig
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / "python" / "stiction"


def main(library: Path, folder: Path) -> Path:
    """Writes the wheel and returns its path."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    version = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    tag, native = kind(project["requires-python"].removeprefix(">="))
    tag += f"-{platform}"
    extras = project["optional-dependencies"]
    about = f"stiction-{version}.dist-info"
    metadata = [
        "Metadata-Version: 2.4",
        "Name: stiction",
        f"Version: {version}",
        f"Summary: {project['description']}",
        f"Requires-Python: {project['requires-python']}",
        *(f"Requires-Dist: {needed}" for needed in project["dependencies"]),
        *(f"Provides-Extra: {extra}" for extra in extras),
        *(f'Requires-Dist: {needed}; extra == "{extra}"' for extra, all_of_it in extras.items() for needed in all_of_it),
    ]
    wheel = ["Wheel-Version: 1.0", "Generator: assemble.py", "Root-Is-Purelib: false", f"Tag: {tag}"]
    sources = sorted(path for path in PACKAGE.rglob("*") if path.suffix in {".py", ".pyi"} or path.name == "py.typed")
    files = {f"stiction/{path.relative_to(PACKAGE).as_posix()}": path.read_bytes() for path in sources}
    files[f"stiction/_native{native}"] = library.read_bytes()
    licences = sorted(path for pattern in project["license-files"] for path in ROOT.glob(pattern))
    files |= {f"{about}/licenses/{path.name}": path.read_bytes() for path in licences}
    scripts = "".join(f"{name} = {function}\n" for name, function in project["scripts"].items())
    files[f"{about}/entry_points.txt"] = f"[console_scripts]\n{scripts}".encode()
    files[f"{about}/METADATA"] = ("\n".join(metadata) + "\n").encode()
    files[f"{about}/WHEEL"] = ("\n".join(wheel) + "\n").encode()
    record = "".join(f"{name},sha256={digest(content)},{len(content)}\n" for name, content in files.items())
    files[f"{about}/RECORD"] = f"{record}{about}/RECORD,,\n".encode()
    folder.mkdir(parents=True, exist_ok=True)
    out = folder / f"stiction-{version}-{tag}.whl"
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name), content, zipfile.ZIP_DEFLATED, compresslevel=9)
    return out


def kind(oldest: str) -> tuple[str, str]:
    """Which Pythons load the native half, and how its name ends: all from the oldest on, or this free-threaded one alone."""
    if not sysconfig.get_config_var("Py_GIL_DISABLED"):
        return f"cp{oldest.replace('.', '')}-abi3", ".abi3.so"
    own = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{own}-{own}t", str(sysconfig.get_config_var("EXT_SUFFIX"))


def digest(content: bytes) -> str:
    """As a RECORD has it."""
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")


if __name__ == "__main__":
    print(main(Path(sys.argv[1]), Path(sys.argv[2])))
