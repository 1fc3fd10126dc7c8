# SPDX-License-Identifier: Apache-2.0
"""An MQTT broker with TLS and a password, and who listens to it."""
import shutil
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

PATIENCE_S = 60
PASSWORD = "secret of the test"
NEEDED = ("mosquitto", "mosquitto_sub", "mosquitto_pub", "mosquitto_passwd", "openssl")

failures = []


def check(holds, claim):
    if not holds:
        failures.append(claim)
    print(("" if holds else "FAILED: ") + claim, flush=True)


def skip_without_broker():
    for program in NEEDED:
        if not shutil.which(program, path="/usr/bin:/usr/sbin:/bin:/sbin"):
            print(f"skipped: no {program}")
            sys.exit(77)


def wait_until(condition):
    end = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def make_certificates(folder):
    def openssl(*words):
        subprocess.run(["openssl", *words], cwd=folder, check=True, capture_output=True)
    openssl("req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", "ca.key", "-out", "ca.crt", "-subj", "/CN=test",
            "-days", "2")
    openssl("req", "-newkey", "rsa:2048", "-nodes", "-keyout", "broker.key", "-out", "broker.csr", "-subj",
            "/CN=localhost")
    (folder / "names").write_text("subjectAltName=DNS:localhost,IP:127.0.0.1\n", encoding="ascii")
    openssl("x509", "-req", "-in", "broker.csr", "-CA", "ca.crt", "-CAkey", "ca.key", "-CAcreateserial", "-out",
            "broker.crt", "-days", "2", "-extfile", "names")


class Broker:
    def __init__(self, folder):
        self.folder = folder
        self.port = free_port()
        make_certificates(folder)
        subprocess.run(["mosquitto_passwd", "-b", "-c", folder / "passwords", "vmc1", PASSWORD], check=True)
        (folder / "broker.conf").write_text(
            f"listener {self.port} 127.0.0.1\ncafile {folder}/ca.crt\ncertfile {folder}/broker.crt\n"
            f"keyfile {folder}/broker.key\npassword_file {folder}/passwords\nallow_anonymous false\n"
            f"persistence true\npersistence_location {folder}/\nuser {Path(folder).owner()}\n", encoding="ascii")
        self.process = None

    def start(self):
        self.process = subprocess.Popen(["mosquitto", "-c", self.folder / "broker.conf"], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        wait_until(self.listens)

    def listens(self):
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    def stop(self):
        self.process.terminate()
        self.process.wait()

    def client(self, *words):
        return [words[0], "-h", "localhost", "-p", str(self.port), "--cafile", self.folder / "ca.crt", "-u", "vmc1", "-P",
                PASSWORD, *words[1:]]

    def publish(self, topic, file):
        def was_taken():
            return subprocess.run(self.client("mosquitto_pub", "-q", "1", "-r", "-t", topic, "-f", file),
                                  capture_output=True).returncode == 0
        return wait_until(was_taken)


class Subscriber:
    """All that arrives, by topic. The broker keeps its session, and what came while it was away."""

    def __init__(self, broker):
        self.messages = {}
        self.process = subprocess.Popen(broker.client("mosquitto_sub", "-i", "watcher", "-c", "-q", "1", "-v", "-t", "#"), text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        threading.Thread(target=self.read, daemon=True).start()

    def read(self):
        for line in self.process.stdout:
            topic, _, payload = line.rstrip("\n").partition(" ")
            self.messages.setdefault(topic, []).append(payload)

    def of(self, topic):
        return self.messages.get(topic, [])

    def has(self, topic, part, count=1):
        return sum(part in payload for payload in self.of(topic)) >= count
