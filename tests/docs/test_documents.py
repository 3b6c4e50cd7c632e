"""Documents say what the code does: the generated one is current, and what the others point at exists."""

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])


def test_the_table_of_messages_is_current() -> None:
    spec = importlib.util.spec_from_file_location("messages_document", ROOT / "docs" / "messages_document.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    current = module.TARGET.read_text() == module.document()
    assert current, "run `.venv/bin/python docs/messages_document.py`"


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_lead_somewhere(document: Path) -> None:
    links = re.findall(r"\]\((?!https?:|#)([^)#]+)[^)]*\)", document.read_text())
    missing = [link for link in links if not (document.parent / link).exists()]
    assert missing == []


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_named_source_files_exist(document: Path) -> None:
    named = set(
        re.findall(
            r"`((?:robot_agent|sim_agent|weaver_console|weaver_shared|web|tests|docs)/[\w/.-]+)`", document.read_text()
        )
    )
    folders = (ROOT, ROOT / "shared")
    missing = [name for name in sorted(named) if not any((folder / name).exists() for folder in folders)]
    assert missing == []
