# SPDX-License-Identifier: GPL-2.0-or-later
"""What the force controller does, for qtvcp: millforce_panel.ui with its HAL pins. millforce_panel_qtvcp.hal wires them. The
pins have the names of the pyvcp panel's."""
import hal
from PyQt5 import QtCore

NO_ESTIMATE = "–"
PERIOD_MS = 100
INPUTS = {hal.HAL_BIT: ("connected", "stopped", "tool-unknown", "tooth-force-valid", "immersion-valid", "depth-valid"),
          hal.HAL_FLOAT: ("override", "tooth-force", "tooth-limit", "tangential-force", "feed-force", "immersion", "depth"),
          hal.HAL_U32: ("state", "fault", "reason"),
          hal.HAL_S32: ("tool",)}
# By their numbers: control/cut_state.hpp, and millforce_guard.
STATES = ("air", "entry", "in cut", "exit", "hold", "FAULT")
FAULTS = ("none", "OVERLOAD", "NO SAMPLES", "SPINDLE STOPPED", "CONFIGURATION", "CURRENT STUCK", "FORCE VANISHED", "FORCE JUMPED",
          "FORCES CONTRADICT", "NEGATIVE TORQUE", "CONTACT IN RAPID", "FEED MISMATCH", "ENCODER MISMATCH", "IDLE TORQUE")
REASONS = ("none", "NEVER HEARD", "HEARTBEAT", "NOT A NUMBER", "NEGATIVE", "NOT OBEYED: M52 P1?")


def word(words, number):
    return words[number] if number < len(words) else str(number)


def load_colour(percent):
    return "#c00000" if percent > 120 else "#e08000" if percent > 100 else "#208020"


class HandlerClass:
    """qtvcp gives the window all these methods, too: none may have the name of one that a window of Qt has."""

    def __init__(self, halcomp, widgets, _paths):
        self.hal, self.w = halcomp, widgets
        self.pins = {}
        self.values = {}
        self.timer = QtCore.QTimer()

    def initialized__(self):
        for kind, names in INPUTS.items():
            for name in names:
                self.pins[name] = self.hal.newpin("millforce-" + name, kind, hal.HAL_IN)
        reset = self.hal.newpin("millforce-reset", hal.HAL_BIT, hal.HAL_OUT)
        self.w.millforce_reset.pressed.connect(lambda: reset.set(True))
        self.w.millforce_reset.released.connect(lambda: reset.set(False))
        self.timer.timeout.connect(self.refresh)
        self.timer.start(PERIOD_MS)

    def estimate_text(self, name, digits):
        """A quantity whose pin NAME-valid says whether there is an estimate."""
        return f"{self.values[name]:.{digits}f}" if self.values[name + "-valid"] else NO_ESTIMATE

    def refresh(self):
        self.values = {name: pin.get() for name, pin in self.pins.items()}
        self.refresh_bars()
        limit_N = self.values["tooth-limit"]
        tool = self.values["tool"]
        for name, text in {"tooth_force": self.estimate_text("tooth-force", 0),
                           "tooth_limit": f"{limit_N:.0f}" if limit_N > 0.0 else NO_ESTIMATE,
                           "tangential_force": f"{self.values['tangential-force']:.0f}",
                           "feed_force": f"{self.values['feed-force']:.0f}",
                           "immersion": self.estimate_text("immersion", 2),
                           "depth": self.estimate_text("depth", 1),
                           "tool": str(tool) if tool > 0 else NO_ESTIMATE,
                           "state": word(STATES, self.values["state"]),
                           "fault": word(FAULTS, self.values["fault"]),
                           "reason": word(REASONS, self.values["reason"])}.items():
            getattr(self.w, "millforce_" + name).setText(text)
        self.refresh_lamps()

    def refresh_bars(self):
        limit_N = self.values["tooth-limit"]
        is_known = limit_N > 0.0 and self.values["tooth-force-valid"]
        percent = round(100.0 * self.values["tooth-force"] / limit_N) if is_known else 0
        self.w.millforce_override.setValue(round(100.0 * self.values["override"]))
        load = self.w.millforce_load
        load.setValue(min(percent, load.maximum()))
        load.setFormat(f"{percent} %" if is_known else NO_ESTIMATE)
        load.setStyleSheet(f"QProgressBar::chunk {{ background: {load_colour(percent)} }}")

    def refresh_lamps(self):
        """Each is seen while there is something to say."""
        self.w.millforce_not_connected.setVisible(not self.values["connected"])
        self.w.millforce_stopped.setVisible(self.values["stopped"])
        self.w.millforce_tool_unknown.setVisible(self.values["tool-unknown"])


def get_handlers(halcomp, widgets, paths):
    return [HandlerClass(halcomp, widgets, paths)]
