"""Two processes' worth of talk on the bus: a robot that tells its battery, and an operator who asks it to stand.

Both ends are Zenoh peers on loopback. With `MemoryBus()` for both the same lines run without a network.
"""

import dataclasses
import math

from weaver_shared import topics
from weaver_shared.bus import ZenohBus, free_port
from weaver_shared.errors import ResourceError
from weaver_shared.latest import LatestSlot
from weaver_shared.messages import Answer, Command, CommandName, PowerState

endpoint = f"tcp/127.0.0.1:{free_port()}"
robot = ZenohBus(listen=[endpoint])
operator = ZenohBus(connect=[endpoint])

# A receiver must return at once: it puts the message into a slot, and whoever is interested takes the newest.
newest: LatestSlot[PowerState] = LatestSlot()
operator.subscribe("*", topics.POWER, lambda robot_id, key, message: newest.put(message))


def answer(command: Command) -> Answer:
    """The robot decides; what it refuses, it refuses with a reason."""
    if command.command is CommandName.STAND and command.operator == "ada":
        return Answer(accepted=True, reason="standing up")
    return Answer(accepted=False, reason=f"{command.operator} does not hold this robot")


robot.serve("example-1", answer)
power = PowerState(
    stamp_ns=0,
    battery_voltage=25.4,
    battery_fraction=0.8,
    supply_power=140.0,
    motor_power=80.0,
    energy=0.0,
    cost_of_transport=math.nan,  # unknown at rest
)
while (heard := newest.take(timeout=0.05)) is None:  # until the subscription has crossed the network
    robot.publish("example-1", topics.POWER, power)
print(f"battery {heard.battery_voltage} V, {heard.battery_fraction:.0%}")

stand = Command(command=CommandName.STAND, operator="ada", lease_epoch=1, sequence=1)
for command in (stand, dataclasses.replace(stand, operator="eve")):
    reply = operator.request("example-1", command, timeout=5.0)
    print(
        f"{command.operator} asks to {command.command}: {'accepted' if reply.accepted else 'refused'}, {reply.reason}"
    )
try:
    operator.request("nobody", stand, timeout=0.2)
except ResourceError as error:
    print(error)

operator.close()
robot.close()
