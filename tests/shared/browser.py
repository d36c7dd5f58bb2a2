"""A page in headless Chromium, driven by its DevTools protocol."""

import json
import shutil
import subprocess
import time
from contextlib import contextmanager

from websockets.sync.client import connect

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
_PATIENCE = 60.0  # [s], for a machine that is busy

# Elements that reach beyond the screen, and what would have to be scrolled sideways.
WIDE = """[...document.querySelectorAll("*")]
  .filter((e) => e.getBoundingClientRect().right > innerWidth + 0.5
              || e.getBoundingClientRect().left < -0.5 || e.scrollWidth > innerWidth)
  .map((e) => e.outerHTML.slice(0, 80))"""


def _wait_for(condition):
    """Whether a condition comes true while one waits."""
    end = time.monotonic() + _PATIENCE
    while not (true := condition()) and time.monotonic() < end:
        time.sleep(0.1)
    return true


class Page:
    """One page; `complaints` has what its console and its scripts complained of."""

    def __init__(self, socket):
        self._socket, self._count, self.complaints = socket, 0, []

    def call(self, method, **parameters):
        """Call a method of the protocol, and note what is reported meanwhile."""
        self._count += 1
        self._socket.send(json.dumps({"id": self._count, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._socket.recv(timeout=_PATIENCE))
            self._note(answer)
            if answer.get("id") == self._count:
                assert "error" not in answer, answer
                return answer["result"]

    def _note(self, report):
        found = report.get("params", {})
        kind = report.get("method")
        if kind == "Runtime.exceptionThrown":
            self.complaints.append(found["exceptionDetails"])
        elif kind == "Log.entryAdded" and found["entry"]["level"] in ("error", "warning"):
            self.complaints.append(found["entry"])
        elif kind == "Runtime.consoleAPICalled" and found["type"] in ("error", "warning", "assert"):
            self.complaints.append(found)
        elif kind == "Network.requestWillBeSent":
            url = found["request"]["url"]
            if not url.startswith(("file:", "data:")):
                self.complaints.append(url)

    def open(self, path, width, height=800, **media):
        """Open a file in a window of a size; media: features, as in a media query."""
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.call(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2, mobile=width < 600
        )
        features = [{"name": name.replace("_", "-"), "value": media[name]} for name in media]
        self.call("Emulation.setEmulatedMedia", features=features)
        self.call("Page.navigate", url=path.absolute().as_uri())
        _wait_for(lambda: self.value("document.readyState") == "complete")
        return self

    def value(self, expression):
        """Value of an expression in the page's JavaScript."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        assert "exceptionDetails" not in answer, answer
        return answer["result"].get("value")

    def wait_for_change(self, expression):
        """Whether the value of an expression changes while one waits."""
        first = self.value(expression)
        return _wait_for(lambda: self.value(expression) != first)


@contextmanager
def browser(profile):
    """Start a browser with a profile in an empty folder; gives a blank page."""
    process = subprocess.Popen(
        [
            CHROMIUM,
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            "--remote-debugging-port=0",
            f"--user-data-dir={profile}",
            "about:blank",
        ],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        port = profile / "DevToolsActivePort"
        _wait_for(lambda: port.exists() and port.read_text().count("\n"))
        number, path = port.read_text().split()
        with connect(f"ws://127.0.0.1:{number}{path}", proxy=None) as socket:
            target = Page(socket).call("Target.createTarget", url="about:blank")["targetId"]
        with connect(f"ws://127.0.0.1:{number}/devtools/page/{target}", max_size=None, proxy=None) as socket:
            yield Page(socket)
    finally:
        process.terminate()
        process.wait(30)
