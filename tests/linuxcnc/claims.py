# SPDX-License-Identifier: Apache-2.0
"""What a case of the LinuxCNC tier says and finds."""
failures = 0


def claim(holds, text):
    global failures
    print(("  " if holds else "  DOES NOT HOLD: ") + text, flush=True)
    failures += 0 if holds else 1


def all_hold():
    return failures == 0
