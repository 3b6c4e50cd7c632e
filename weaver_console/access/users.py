"""The users in the console's database, and the tokens by which their programs come in."""

from __future__ import annotations

import hashlib
import secrets
import time
from collections.abc import Callable
from dataclasses import dataclass

from weaver_console import operator_names
from weaver_console.access.passwords import hashed, matches, nobodys
from weaver_console.access.roles import Identity, Role
from weaver_console.database import Database
from weaver_shared.errors import InputError


@dataclass(frozen=True, slots=True, kw_only=True)
class User:
    """`added` is unix time in s."""

    name: str
    role: Role
    added: float
    tokens: int

    def to_page(self) -> dict[str, object]:
        return {"name": self.name, "role": self.role.value, "added": self.added, "tokens": self.tokens}


class UserStore:
    """Raises InputError on names, roles and passwords that are not valid, and on users that there are not."""

    def __init__(self, database: Database, wall_time: Callable[[], float] = time.time) -> None:
        self._database = database
        self._wall_time = wall_time

    def all(self) -> list[User]:
        """By name."""
        rows = self._database.read(
            "select name, role, added, (select count(*) from token where token.user = name) from user order by name"
        )
        return [
            User(name=str(name), role=Role(str(role)), added=float(str(added)), tokens=int(str(tokens)))
            for name, role, added, tokens in rows
        ]

    @property
    def exist(self) -> bool:
        return bool(self._database.read("select 1 from user limit 1"))

    def add(self, name: str, role: Role, password: str) -> None:
        name = operator_names.valid(name)
        if self.find(name) is not None:
            raise InputError(f"there is a user {name!r} already")
        row = (name, role.value, hashed(password), round(self._wall_time(), 3))
        self._database.write("insert into user values (?, ?, ?, ?)", [row])

    def remove(self, name: str) -> None:
        self._require(name)
        self._require_other_admin(name)
        self._forget(name)
        self._database.write("delete from user where name = ?", [(name,)])

    def set_password(self, name: str, password: str) -> None:
        """Ends the user's sessions and tokens, too: whoever changes a password may have lost it."""
        self._require(name)
        self._database.write("update user set password = ? where name = ?", [(hashed(password), name)])
        self._forget(name)

    def set_role(self, name: str, role: Role) -> None:
        self._require(name)
        if role is not Role.ADMIN:
            self._require_other_admin(name)
        self._database.write("update user set role = ? where name = ?", [(role.value, name)])

    def find(self, name: str) -> Identity | None:
        rows = self._database.read("select name, role from user where name = ?", (name,))
        return Identity(name=str(rows[0][0]), role=Role(str(rows[0][1]))) if rows else None

    def check(self, name: str, password: str) -> Identity | None:
        """The user, if this is their password. Takes some 50 ms, whether there is such a user or not."""
        rows = self._database.read("select password from user where name = ?", (name,))
        right = matches(password, str(rows[0][0]) if rows else nobodys())
        return self.find(name) if right and rows else None

    def add_token(self, name: str) -> str:
        """A new token of the user's; it is kept only as a hash, so this is the one time that it is told."""
        self._require(name)
        token = f"weaver_{secrets.token_urlsafe(32)}"
        row = (digest_of(token), name, round(self._wall_time(), 3))
        self._database.write("insert into token values (?, ?, ?)", [row])
        return token

    def remove_tokens(self, name: str) -> int:
        self._require(name)
        return self._database.write("delete from token where user = ?", [(name,)])

    def by_token(self, token: str) -> Identity | None:
        rows = self._database.read("select user from token where digest = ?", (digest_of(token),))
        return self.find(str(rows[0][0])) if rows else None

    def _require(self, name: str) -> None:
        if self.find(name) is None:
            known = ", ".join(user.name for user in self.all()) or "none yet"
            raise InputError(f"there is no user {name!r:.60}; known are {known}")

    def _require_other_admin(self, name: str) -> None:
        admins = {user.name for user in self.all() if user.role is Role.ADMIN}
        if admins == {name}:
            raise InputError(f"{name} is the only admin; make another one first")

    def _forget(self, name: str) -> None:
        for table in ("session", "token"):
            self._database.write(f"delete from {table} where user = ?", [(name,)])


def digest_of(secret: str) -> str:
    """What is kept of a secret that a computer made up: it needs no salt and no slowness."""
    return hashlib.sha256(secret.encode("utf-8", "surrogatepass")).hexdigest()
