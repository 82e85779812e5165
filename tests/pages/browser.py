"""A headless Chromium, driven through chromedriver (W3C WebDriver over HTTP) by the standard library alone."""
import base64
import json
import re
import subprocess
import tempfile
import time
import urllib.error
import urllib.request


class Browser:
    """One window. Use as `with Browser(width, height) as browser`."""

    def __init__(self, width=1280, height=900, dark=False):
        self.profile = tempfile.TemporaryDirectory()
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                       text=True)
        try:
            self.root = f"http://127.0.0.1:{self._port()}"
            arguments = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars",
                         "--no-first-run", "--disable-background-networking", "--force-color-profile=srgb",
                         "--allow-file-access-from-files=false", f"--user-data-dir={self.profile.name}",
                         f"--window-size={width},{height}"]
            wanted = {"browserName": "chrome", "goog:chromeOptions": {"args": arguments},
                      "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"}}
            made = self._send("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
            self.session = f"/session/{made['sessionId']}"
            self.version = made["capabilities"]["browserVersion"]
        except BaseException:
            self.close()
            raise
        self.resize(width, height)
        self.theme("dark" if dark else "light")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        if hasattr(self, "session"):
            try:
                self._send("DELETE", self.session)
            except (OSError, RuntimeError):
                pass  # it ended by itself
        self.driver.terminate()
        self.driver.wait(10)
        self.driver.stdout.close()
        self.profile.cleanup()

    def _port(self):
        for line in self.driver.stdout:
            found = re.search(r"started successfully on port (\d+)", line)
            if found:
                return found[1]
        raise RuntimeError("chromedriver did not start")

    def _send(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.root + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=120) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(f"{method} {path}: {json.load(error)['value']['message']}") from None

    def cdp(self, command, **parameters):
        """A command of the Chrome DevTools protocol."""
        return self._send("POST", self.session + "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def resize(self, width, height, mobile=False, ratio=1):
        self.cdp("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=ratio, mobile=mobile)

    def theme(self, name):
        self.cdp("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": name}])

    def scripts(self, allowed):
        self.cdp("Emulation.setScriptExecutionDisabled", value=not allowed)

    def open(self, path, fragment=""):
        """Opens a file, and waits until it has loaded."""
        self._send("POST", self.session + "/url", {"url": f"file://{path}{fragment}"})

    def run(self, script, *arguments):
        """The value that a script returns."""
        return self._send("POST", self.session + "/execute/sync", {"script": script, "args": list(arguments)})

    def wait(self, condition, seconds=10):
        """Waits until an expression is true."""
        end = time.monotonic() + seconds
        while not self.run(f"return !!({condition});"):
            if time.monotonic() > end:
                raise AssertionError(f"after {seconds} s there is still no: {condition}")
            time.sleep(0.02)

    def mouse(self, kind, x, y, button="left", **more):
        self.cdp("Input.dispatchMouseEvent", type=kind, x=x, y=y, button=button, clickCount=1, **more)

    def click(self, x, y):
        self.mouse("mouseMoved", x, y, "none")
        self.mouse("mousePressed", x, y)
        self.mouse("mouseReleased", x, y)

    def drag(self, x0, y0, x1, y1):
        self.mouse("mouseMoved", x0, y0, "none")
        self.mouse("mousePressed", x0, y0)
        for step in range(1, 5):
            self.mouse("mouseMoved", x0 + (x1 - x0) * step / 4, y0 + (y1 - y0) * step / 4, buttons=1)
        self.mouse("mouseReleased", x1, y1)

    def wheel(self, x, y, by):
        self.mouse("mouseWheel", x, y, "none", deltaX=0, deltaY=by)

    def key(self, key, code="", modifiers=0, text=None):
        typed = text if text is not None else (key if len(key) == 1 else "")
        self.cdp("Input.dispatchKeyEvent", type="keyDown", key=key, code=code, modifiers=modifiers, text=typed)
        self.cdp("Input.dispatchKeyEvent", type="keyUp", key=key, code=code, modifiers=modifiers)

    def screenshot(self, path, whole=False):
        shot = self.cdp("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        with open(path, "wb") as file:
            file.write(base64.b64decode(shot["data"]))

    def pdf(self):
        return base64.b64decode(self.cdp("Page.printToPDF", printBackground=True)["data"])

    def complaints(self):
        """What the console was told since the last call, but for mere information."""
        log = self._send("POST", self.session + "/se/log", {"type": "browser"})
        return [entry["message"] for entry in log if entry["level"] in ("WARNING", "SEVERE")]

    def requests(self):
        """The addresses that were asked for since the last call."""
        log = self._send("POST", self.session + "/se/log", {"type": "performance"})
        events = [json.loads(entry["message"])["message"] for entry in log]
        return [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]
