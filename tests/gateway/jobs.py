# SPDX-License-Identifier: Apache-2.0
"""Jobs of `serve` and the settings of a gateway that reports them."""
import signal
import subprocess
import time

from broker import PASSWORD, wait_until
from cnc import Cnc

COUNTS_PER_REV = 8192  # of the machine's file


def record_a_slot(millforce, scenarios, folder):
    subprocess.run([millforce, "simulate", scenarios / "slot_entry.toml", "--record", "--out", folder], check=True,
                   stdout=subprocess.DEVNULL)


def mill_a_slot(millforce, scenarios, folder):
    """A job of `serve`, as fast as it goes."""
    serve = subprocess.Popen([millforce, "serve", folder / "a.sock", "--gateway", folder / "telemetry.sock", "--jobs",
                              folder / "jobs", "--machine", scenarios / "machines" / "vmc.toml", "--tool",
                              scenarios / "tools" / "endmill_10mm.toml"], stderr=subprocess.DEVNULL)
    wait_until((folder / "a.sock").exists)
    time.sleep(0.2)
    cnc = Cnc(str(folder / "a.sock"), folder / "recording.csv", COUNTS_PER_REV)
    for sequence, row in enumerate(cnc.rows, 1):
        cnc.socket.send(cnc.sample(sequence, *cnc.place_of(row), row))
        cnc.socket.recv(1024)
        if sequence % 500 == 0:
            time.sleep(0.05)
    cnc.socket.close()
    serve.send_signal(signal.SIGTERM)
    serve.wait()


def write_settings(folder, port, password="password"):
    (folder / "password").write_text(PASSWORD + "\n", encoding="ascii")
    (folder / "wrong").write_text("wrong\n", encoding="ascii")
    file = folder / f"gateway_{password}.toml"
    file.write_text(f"""machine = "vmc1"
jobs = "{folder}/jobs"
tools = "{folder}/tools"
telemetry_socket = "{folder}/telemetry.sock"
[broker]
host = "localhost"
port = {port}
ca_file = "{folder}/ca.crt"
username = "vmc1"
password_file = "{folder}/{password}"
""", encoding="ascii")
    return file


def make_folders(folder):
    for inner in ("jobs", "tools"):
        (folder / inner).mkdir()
