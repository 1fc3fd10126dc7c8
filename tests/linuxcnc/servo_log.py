# SPDX-License-Identifier: Apache-2.0
"""LinuxCNC's own records of a session, one row per servo cycle: motion.txt, answers.txt (sim/linuxcnc/recording.hal)."""
from typing import NamedTuple

FEED_MOTION = 2  # motion.motion-type of G1


class Cycle(NamedTuple):
    number: int
    adaptive: float  # at motion.adaptive-feed
    speed: float  # motion.current-vel, mm/s
    requested: float  # F, mm/s
    x: float
    y: float
    z: float
    tooth_force: float  # N, the plant's truth
    heartbeat: int
    answered: int
    override: float  # what the controller asked for
    inhibit: int
    fault: int
    reason: int
    machine_ok: int
    spindle_on: int
    motion: int
    unanswered: int

    def is_feed(self):
        return self.motion == FEED_MOTION


def in_mm(cycles, mm_per_unit):
    """The log of a machine in other units than millimetres."""
    return [c._replace(speed=c.speed * mm_per_unit, requested=c.requested * mm_per_unit, x=c.x * mm_per_unit, y=c.y * mm_per_unit,
                       z=c.z * mm_per_unit) for c in cycles]


class Answer(NamedTuple):
    """answers.txt: what stood on the pins once the controller had answered all samples so far."""
    number: int
    heartbeat: int
    answered: int
    override: float


def read(path, row=Cycle):
    cycles = []
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if len(words) == len(row._fields):  # the last line may be cut off
                cycles.append(row(*(kind(word) for kind, word in zip(row.__annotations__.values(), words))))
    assert len(cycles) > 1000, f"{path}: {len(cycles)} rows"
    gaps = [a.number for a, b in zip(cycles, cycles[1:]) if b.number != a.number + 1]
    assert not gaps, f"{path}: the sampler lost rows after {gaps[:3]}"
    return cycles
