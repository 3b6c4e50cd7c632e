"""The tree of a URDF: the trunk, and the legs that hang from it as chains of turning joints."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import InputError
from weaver_shared.robots.urdf.elements import FIXED, TURNING, Solid, UrdfJoint, UrdfLink
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

First = tuple[UrdfJoint, list[UrdfJoint] | None]
"""Of a branch: its first joint and, if it is a chain of turning joints, all of them."""
FEWEST_JOINTS, MOST_JOINTS = 3, 6
FEWEST_LEGS, MOST_LEGS = 3, 8
FOOT_RADIUS = 0.05
"""Of the leg's length, where the URDF has no sphere at its end."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Branch:
    """A leg at its zero angles, in body: a line for every joint, and where the foot is."""

    joints: tuple[UrdfJoint, ...]
    points: Array  # (n, 3) m, on the axes
    axes: Array  # (n, 3) unit
    masses: Array  # (n,) kg of the link after every joint, with what is fixed to it
    foot: Array  # (3,) m
    foot_radius: float  # m

    @property
    def length(self) -> float:
        """From joint to joint and on to the foot, m."""
        return float(np.linalg.norm(np.diff(np.vstack([self.points, self.foot]), axis=0), axis=1).sum())


@dataclass(frozen=True, slots=True, kw_only=True)
class Trunk:
    mass: float  # kg
    centre: Array  # (3,) m in body
    corners: Array  # (2, 3) m, of the box around its solids; empty (0, 3) without any


class Tree:
    """Links and joints of a URDF; the body frame is that of the link which all legs hang from."""

    def __init__(self, links: dict[str, UrdfLink], joints: tuple[UrdfJoint, ...]) -> None:
        self._links = links
        self._children: dict[str, list[UrdfJoint]] = defaultdict(list)
        self._parent: dict[str, UrdfJoint] = {}
        for joint in joints:
            if joint.child in self._parent:
                first = self._parent[joint.child].name
                raise InputError(
                    f"link {joint.child!r} hangs from the joints {first!r} and {joint.name!r}; valid is one"
                )
            self._parent[joint.child] = joint
            self._children[joint.parent].append(joint)
        roots = [name for name in links if name not in self._parent]
        if len(roots) != 1:
            found = ", ".join(roots) or "none, the joints go round in a circle"
            raise InputError(f"links that hang from no joint: {found:.200}; valid is exactly one, the trunk")
        self._root = roots[0]
        reached = {name for name, _ in self._fixed_to(self._root, kinds=None)}
        if len(reached) != len(links):
            lost = sorted(set(links) - reached)[0]
            raise InputError(
                f"link {lost!r} does not hang from the trunk {self._root!r}; its joints go round in a circle"
            )
        while len(only := self._children[self._root]) == 1 and only[0].kind not in TURNING:
            self._root = only[0].child  # such as a footprint on the ground, or the world

    def legs(self) -> tuple[tuple[Branch, ...], Trunk]:
        """All branches that are legs, in body, and all that is not; raises InputError."""
        trunk = dict(self._fixed_to(self._root, kinds=(FIXED,)))
        found: list[First] = []
        others: list[First] = []
        for link in trunk:
            for joint in self._children[link]:
                if joint.kind == FIXED:
                    continue
                chain = self._chain(joint)
                is_leg = chain is not None and FEWEST_JOINTS <= len(chain) <= MOST_JOINTS
                (found if is_leg else others).append((joint, chain))
        if not FEWEST_LEGS <= len(found) <= MOST_LEGS:
            raise InputError(self._miscounted(found, others))
        counts = {chain[0].name: len(chain) for _, chain in found if chain}
        if len(set(counts.values())) > 1:
            told = ", ".join(f"{name!r} {count}" for name, count in counts.items())
            raise InputError(
                f"legs have different numbers of joints, counted from their first: {told}; valid is the same"
            )
        body = self._common([joint.parent for joint, _ in found])
        body_from_root = trunk[body].inverse()
        branches = tuple(self._branch(chain, body_from_root @ trunk[first.parent]) for first, chain in found if chain)
        parts = [(body_from_root @ pose, self._links[name]) for name, pose in trunk.items()]
        for joint, _ in others:
            start = body_from_root @ trunk[joint.parent] @ joint.parent_from_joint
            parts += [(start @ pose, self._links[name]) for name, pose in self._fixed_to(joint.child, kinds=None)]
        return branches, _trunk(parts)

    def _miscounted(self, found: list[First], others: list[First]) -> str:
        told = [
            f"{joint.name!r} with {'a fork or a sliding joint' if chain is None else f'{len(chain)} joints'}"
            for joint, chain in others
        ]
        rest = f"; no legs are the branches at {', '.join(told):.300}" if told else ""
        return (
            f"{len(found)} legs hang from {self._root!r}; valid are {FEWEST_LEGS} to {MOST_LEGS} chains of "
            f"{FEWEST_JOINTS} to {MOST_JOINTS} revolute joints each{rest}"
        )

    def _fixed_to(self, link: str, *, kinds: tuple[str, ...] | None) -> list[tuple[str, Pose]]:
        """A link and all that hang from it by joints of these kinds (None: all), seen from it at zero angles."""
        result, todo, seen = [], [(link, Pose.identity())], set()
        while todo:
            name, pose = todo.pop(0)
            if name in seen:
                continue
            seen.add(name)
            result.append((name, pose))
            todo += [
                (joint.child, pose @ joint.parent_from_joint)
                for joint in self._children[name]
                if kinds is None or joint.kind in kinds
            ]
        return result

    def _chain(self, first: UrdfJoint) -> list[UrdfJoint] | None:
        """Moving joints from this one to the end; None if one slides or the chain forks."""
        chain = [first]
        while True:
            if chain[-1].kind not in TURNING:
                return None
            fixed = self._fixed_to(chain[-1].child, kinds=(FIXED,))
            further = [joint for name, _ in fixed for joint in self._children[name] if joint.kind != FIXED]
            if len(further) > 1:
                return None
            if not further:
                return chain
            chain.append(further[0])

    def _common(self, links: list[str]) -> str:
        """The link nearest to these from which all hang."""
        paths = []
        for name in links:
            path = [name]
            while path[-1] != self._root:
                path.append(self._parent[path[-1]].parent)
            paths.append(path)
        return next(name for name in paths[0] if all(name in path for path in paths))

    def _branch(self, chain: list[UrdfJoint], body_from_parent: Pose) -> Branch:
        points, axes, masses = [], [], []
        link = chain[0].parent
        for joint in chain:
            within = dict(self._fixed_to(link, kinds=(FIXED,)))
            body_from_joint = body_from_parent @ within[joint.parent] @ joint.parent_from_joint
            points.append(body_from_joint.position)
            axes.append(body_from_joint.rotation @ joint.axis)
            body_from_parent, link = body_from_joint, joint.child
            masses.append(sum(self._links[name].mass for name, _ in self._fixed_to(link, kinds=(FIXED,))))
        reach = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
        foot, radius = self._foot(link, reach)
        return Branch(
            joints=tuple(chain),
            points=np.array(points),
            axes=np.array(axes),
            masses=np.array(masses),
            foot=body_from_parent.transform(foot),
            foot_radius=radius,
        )

    def _foot(self, link: str, reach: float) -> tuple[Array, float]:
        """Centre (3,) of the foot in the last link's frame, and its radius: a sphere, a fixed link, or the far end."""
        parts = self._fixed_to(link, kinds=(FIXED,))
        solids = [(pose @ solid.link_from_solid, solid) for name, pose in parts for solid in self._links[name].solids]
        spheres = [(pose.position, 0.5 * float(solid.size[0])) for pose, solid in solids if solid.kind == "sphere"]
        spheres = [one for one in spheres if float(np.linalg.norm(one[0])) > 0.0 and one[1] > 0.0]
        guess = FOOT_RADIUS * reach
        if spheres:
            return max(spheres, key=lambda one: float(np.linalg.norm(one[0])))
        fixed = [pose.position for _, pose in parts[1:]]
        ends = fixed or [end for pose, solid in solids for end in _ends(pose, solid)]
        far = max(ends, key=lambda end: float(np.linalg.norm(end)), default=np.zeros(3))
        if float(np.linalg.norm(far)) < 1e-6:
            raise InputError(
                f"link {link!r}: where its foot is can not be told, for it has neither a shape other than a mesh nor a "
                "link fixed to its end; valid is a fixed joint to a link at the foot"
            )
        return far, max(guess, 1e-4)


def _ends(pose: Pose, solid: Solid) -> list[Array]:
    """Centres of the faces of the box around a solid."""
    half = 0.5 * solid.size
    return [pose.transform(sign * half * axis) for axis in np.eye(3) for sign in (-1.0, 1.0)]


def _trunk(parts: list[tuple[Pose, UrdfLink]]) -> Trunk:
    mass = sum(link.mass for _, link in parts)
    centre = sum((link.mass * pose.transform(link.centre) for pose, link in parts), np.zeros(3))
    corners = [
        (pose @ solid.link_from_solid).transform(0.5 * solid.size * np.array(signs))
        for pose, link in parts
        for solid in link.solids
        for signs in product((-1.0, 1.0), repeat=3)
    ]
    box = np.array([np.min(corners, axis=0), np.max(corners, axis=0)]) if corners else np.zeros((0, 3))
    return Trunk(mass=mass, centre=centre / mass if mass > 0.0 else np.zeros(3), corners=box)
