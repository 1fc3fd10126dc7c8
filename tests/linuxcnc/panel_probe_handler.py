# SPDX-License-Identifier: Apache-2.0
"""The panel's own handler, and a record of what can be seen: panel.jsonl gets a line at each change, panel_STATE.png the
picture."""
import json

from PyQt5 import QtWidgets

import millforce_panel_handler as panel


class HandlerClass(panel.HandlerClass):
    seen = None

    def refresh(self):
        super().refresh()
        seen = {widget.objectName().removeprefix("millforce_"): widget.text()
                for kind in (QtWidgets.QLabel, QtWidgets.QProgressBar) for widget in self.w.findChildren(kind)
                if widget.objectName().startswith("millforce_") and widget.isVisible()}
        button = self.w.millforce_reset
        centre = button.mapToGlobal(button.rect().center())
        seen["button"] = [centre.x(), centre.y()]
        if seen != self.seen:
            self.seen = seen
            with open("panel.jsonl", "a", encoding="utf-8") as file:
                file.write(json.dumps(seen) + "\n")
            lamp = "tool_unknown" if "tool_unknown" in seen else seen.get("state", "hidden").replace(" ", "_")
            self.w.grab().save(f"panel_{lamp}.png")


def get_handlers(halcomp, widgets, paths):
    return [HandlerClass(halcomp, widgets, paths)]
