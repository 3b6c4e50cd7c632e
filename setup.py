"""Puts the built page into the wheel, as `weaver_console/_web`; everything else is in pyproject.toml."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

PAGE = Path(__file__).parent / "web" / "dist"


class BuildWithPage(build_py):
    """An editable install serves `web/dist` in place; a wheel without the page would be a broken console."""

    def run(self) -> None:
        super().run()
        if self.editable_mode:
            return
        if not (PAGE / "index.html").is_file():
            raise SystemExit("the page is not built: run `npm ci && npm run build` in web/ before building a wheel")
        shutil.copytree(PAGE, Path(self.build_lib) / "weaver_console" / "_web", dirs_exist_ok=True)


setup(cmdclass={"build_py": BuildWithPage})
