"""Where the built page is, and what the console says without one."""

import html
from pathlib import Path

_PACKAGE = Path(__file__).parent

_LOGIN = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>Weaver Console: log in</title>
<style>
:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; }
body { display: grid; place-items: center; min-height: 100vh; margin: 0; }
form { display: grid; gap: 0.75rem; width: min(20rem, 90vw); }
input, button { font: inherit; padding: 0.6rem 0.8rem; }
.wrong { color: light-dark(#a3101c, #ff9aa2); margin: 0; }
</style></head><body><main><form method="post" action="/api/login">
<h1>Weaver Console</h1>
{reason}<label for="name">Name</label>
<input id="name" name="name" autocomplete="username" autofocus required>
<label for="password">Password</label>
<input id="password" name="password" type="password" autocomplete="current-password" required>
<button type="submit">Log in</button>
</form></main></body></html>
"""

NOT_BUILT = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Weaver Console</title></head><body><main>
<h1>The page is not built</h1>
<p>The console runs, but its page has not been built yet. Start it with <code>./weaver up</code>, which builds the
page, or run <code>npm ci</code> and <code>npm run build</code> in the folder <code>web</code>; then load this page
again.</p>
</main></body></html>
"""


def login_page(reason: str = "") -> str:
    """The form, with why the last try was refused."""
    told = f'<p class="wrong" role="alert">{html.escape(reason.capitalize())}.</p>\n' if reason else ""
    return _LOGIN.replace("{reason}", told)


def page_folder() -> Path | None:
    """The page inside the package, else the build of a source tree, else None."""
    for folder in (_PACKAGE / "_web", _PACKAGE.parent / "web" / "dist"):
        if (folder / "index.html").is_file():
            return folder
    return None


def file_at(folder: Path, path: str) -> Path | None:
    """The page's file at an address; None where there is none, or where no file can be."""
    try:
        wanted = (folder / path).resolve()
        return wanted if wanted.is_relative_to(folder.resolve()) and wanted.is_file() else None
    except (OSError, ValueError):  # a name too long for the disk, or with a zero byte
        return None
