"""What a user may do: watch, operate, or look after the users as well. Whoever may see a robot may stop it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from weaver_shared.errors import InputError
from weaver_shared.messages import CommandName


class Role(StrEnum):
    VIEWER = "viewer"
    OPERATOR = "operator"
    ADMIN = "admin"

    @classmethod
    def named(cls, name: str) -> Role:
        """Raises InputError on a role that there is not."""
        try:
            return cls(name)
        except ValueError:
            raise InputError(f"role {name!r:.40} is unknown; known are {', '.join(cls)}") from None


@dataclass(frozen=True, slots=True, kw_only=True)
class Identity:
    """Who speaks: `name` is empty where nobody needs to log in."""

    name: str
    role: Role

    @property
    def operates(self) -> bool:
        return self.role is not Role.VIEWER

    @property
    def administers(self) -> bool:
        return self.role is Role.ADMIN

    def refusal(self, command: CommandName) -> str:
        """Why this command is not theirs to give; empty if it is."""
        if self.operates or command is CommandName.STOP:
            return ""
        return f"{self.name} is a viewer, who may watch and stop the robot; ask an operator"


OPEN = Identity(name="", role=Role.ADMIN)
"""Whoever sits at this computer."""
