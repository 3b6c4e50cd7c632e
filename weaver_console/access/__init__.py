"""Who may use the console: users with roles, passwords, sessions and tokens, and where a request may come from."""

from weaver_console.access.gate import Access
from weaver_console.access.origins import is_loopback
from weaver_console.access.roles import OPEN, Identity, Role
from weaver_console.access.sessions import COOKIE, VALID_S
from weaver_console.access.users import UserStore

__all__ = ["COOKIE", "OPEN", "VALID_S", "Access", "Identity", "Role", "UserStore", "is_loopback"]
