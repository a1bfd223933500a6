"""Chromium and Firefox without a screen, driven over what both have without further programs: Chromium's protocol on two
pipes, Firefox's Marionette on a local socket (with an X server of no screen, since headless Firefox has no WebGL in software). What a page logs as an error, and what it asks the network for, is kept."""
import base64
import json
import os
import shutil
import socket
import subprocess
import tempfile
import time

LIMIT = 120.0  # seconds for any one answer


class Failure(Exception):
    pass


def wait_for(browser):
    """Until the file is read to its end, and all its images are inflated."""
    end = time.monotonic() + LIMIT
    while not browser.call("return location.protocol === 'file:' && document.readyState === 'complete' && "
                           "(typeof aspic === 'undefined' || aspic.player.complete)"):
        if time.monotonic() > end:
            raise Failure("the page was not read to its end")
        time.sleep(0.05)


def on_the_way(fingers, share):
    """Where they are then."""
    return [tuple(a + share * (b - a) for a, b in zip(from_, to)) for from_, to in fingers]


def end(process):
    process.terminate()
    try:
        process.wait(10)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


class Chromium:
    name = "chromium"
    programs = ["chromium", "chromium-browser", "google-chrome"]
    keys = {"ArrowLeft": 37, "ArrowRight": 39, "Home": 36, "End": 35, " ": 32}

    def __init__(self, program):
        self.profile = tempfile.mkdtemp(prefix="aspic-chromium-")
        self.errors, self.requests, self.answers, self.number, self.text = [], [], {}, 0, b""
        read_back, write_back = os.pipe()
        read_there, write_there = os.pipe()
        words = [program, "--headless", "--no-sandbox", "--remote-debugging-pipe", "--use-angle=gl-egl",  # Mesa's rasterizer, as of all our tests
                 "--ignore-gpu-blocklist", "--hide-scrollbars", "--no-first-run", "--disable-background-networking",
                 "--disable-component-update", f"--user-data-dir={self.profile}", "about:blank"]

        def wire():  # pipes 3 and 4 are the browser's
            os.dup2(read_there, 103)
            os.dup2(write_back, 104)
            os.dup2(103, 3)
            os.dup2(104, 4)
            os.set_inheritable(3, True)
            os.set_inheritable(4, True)

        env = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"}
        self.process = subprocess.Popen(words, env=env, preexec_fn=wire, close_fds=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(read_there)
        os.close(write_back)
        self.incoming, self.outgoing = read_back, write_there
        self.session = None
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Log", "Network"]:
            self.ask(f"{domain}.enable")

    def ask(self, method, **params):
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.outgoing, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + LIMIT
        while self.number not in self.answers:
            if time.monotonic() > end:
                raise Failure(f"no answer to {method}")
            self.listen()
        answer = self.answers.pop(self.number)
        if "error" in answer:
            raise Failure(f"{method}: {answer['error']}")
        return answer["result"]

    def listen(self):
        import select
        if not select.select([self.incoming], [], [], 1.0)[0]:
            if self.process.poll() is not None:
                raise Failure("the browser ended")
            return
        piece = os.read(self.incoming, 1 << 20)
        if not piece:
            raise Failure("the browser ended")
        *messages, self.text = (self.text + piece).split(b"\0")
        for text in messages:
            message = json.loads(text)
            if "id" in message:
                self.answers[message["id"]] = message
            else:
                self.note(message["method"], message.get("params", {}))

    def note(self, method, params):
        if method == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description") or details["text"])
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "assert", "warning"):
            self.errors.append(" ".join(str(a.get("value", a.get("description"))) for a in params["args"]))
        elif method == "Log.entryAdded" and params["entry"]["level"] in ("error", "warning"):
            # What the software rasterizer says of itself is no fault of the page's.
            if "GPU stall" not in params["entry"]["text"]:
                self.errors.append(params["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"])

    def open(self, path, width=1280, height=720, dark=False, phone=False):
        self.errors.clear()
        self.requests.clear()
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)
        self.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.ask("Page.navigate", url="about:blank")
        self.ask("Page.navigate", url=f"file://{os.path.abspath(path)}#paused")
        wait_for(self)
        self.requests = [url for url in self.requests if url != "about:blank"]

    def call(self, expression):
        result = self.ask("Runtime.evaluate", expression=f"(async () => {{ {expression} }})()", awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise Failure(result["exceptionDetails"].get("exception", {}).get("description", "an exception"))
        return result["result"].get("value")

    def key(self, key):
        code = self.keys.get(key, ord(key.upper()[0]))
        event = {"key": key, "windowsVirtualKeyCode": code}
        self.ask("Input.dispatchKeyEvent", type="keyDown", **event, **({"text": key} if len(key) == 1 else {}))
        self.ask("Input.dispatchKeyEvent", type="keyUp", **event)

    def drag(self, from_, to):
        steps = [("mousePressed", from_), ("mouseMoved", [(a + b) / 2 for a, b in zip(from_, to)]), ("mouseMoved", to), ("mouseReleased", to)]
        for kind, (x, y) in steps:
            self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=0 if kind == "mouseReleased" else 1, clickCount=1)

    def touch(self, fingers):
        """Fingers from … to [((x, y), (x, y)), …], all at once, in three steps."""
        self.ask("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
        for step in range(5):
            points = [] if step == 4 else [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(on_the_way(fingers, step / 3))]
            self.ask("Input.dispatchTouchEvent", type="touchStart" if step == 0 else "touchEnd" if step == 4 else "touchMove", touchPoints=points)
        self.ask("Emulation.setTouchEmulationEnabled", enabled=False)

    def wheel(self, at, down):
        self.ask("Input.dispatchMouseEvent", type="mouseWheel", x=at[0], y=at[1], deltaX=0, deltaY=down)

    def screenshot(self):
        return base64.b64decode(self.ask("Page.captureScreenshot", format="png")["data"])

    def close(self):
        end(self.process)
        os.close(self.incoming)
        os.close(self.outgoing)
        shutil.rmtree(self.profile, ignore_errors=True)


class Firefox:
    name = "firefox"
    programs = ["firefox-esr", "firefox"]
    keys = {"ArrowLeft": "\ue012", "ArrowRight": "\ue014", "Home": "\ue011", "End": "\ue010"}

    def __init__(self, program):
        self.profile = tempfile.mkdtemp(prefix="aspic-firefox-")
        prefs = {"marionette.port": 0, "webgl.force-enabled": True,  "browser.shell.checkDefaultBrowser": False,
                 "datareporting.policy.dataSubmissionEnabled": False, "app.update.enabled": False, "network.captive-portal-service.enabled": False,
                 "network.connectivity-service.enabled": False, "toolkit.telemetry.reportingpolicy.firstRun": False, "layout.css.devPixelsPerPx": "1.0"}
        with open(os.path.join(self.profile, "user.js"), "w") as file:
            for name, value in prefs.items():
                file.write(f"user_pref({json.dumps(name)}, {json.dumps(value)});\n")
        words = [program, "--marionette", "--remote-allow-system-access", "--no-remote", "--profile", self.profile]
        told, tell = os.pipe()
        self.display = subprocess.Popen(["Xvfb", "-displayfd", str(tell), "-screen", "0", "1700x1300x24", "-nolisten", "tcp"],
                                        pass_fds=[tell], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(tell)
        with os.fdopen(told) as answer:
            display = ":" + answer.readline().strip()
        env = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1", "HOME": self.profile, "DISPLAY": display}
        self.process = subprocess.Popen(words, env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.number, self.text = 0, b""
        port = os.path.join(self.profile, "MarionetteActivePort")
        end = time.monotonic() + LIMIT
        while not (os.path.exists(port) and open(port).read().strip()):
            if time.monotonic() > end or self.process.poll() is not None:
                raise Failure("Firefox did not start")
            time.sleep(0.1)
        self.socket = socket.create_connection(("127.0.0.1", int(open(port).read())), LIMIT)
        self.receive()
        self.ask("WebDriver:NewSession", {"pageLoadStrategy": "eager", "timeouts": {"script": int(1000 * LIMIT)}})

    def receive(self):
        while b":" not in self.text:
            self.more()
        size, self.text = self.text.split(b":", 1)
        while len(self.text) < int(size):
            self.more()
        message, self.text = json.loads(self.text[:int(size)]), self.text[int(size):]
        return message

    def more(self):
        piece = self.socket.recv(1 << 20)
        if not piece:
            raise Failure("Firefox ended")
        self.text += piece

    def ask(self, method, params=None):
        self.number += 1
        text = json.dumps([0, self.number, method, params or {}]).encode()
        self.socket.sendall(str(len(text)).encode() + b":" + text)
        while True:
            kind, number, error, result = self.receive()
            if kind == 1 and number == self.number:
                break
        if error:
            raise Failure(f"{method}: {error['message']}")
        return result

    def in_chrome(self, script):
        self.ask("Marionette:SetContext", {"value": "chrome"})
        try:
            return self.ask("WebDriver:ExecuteScript", {"script": script, "args": [], "newSandbox": False})["value"]
        finally:
            self.ask("Marionette:SetContext", {"value": "content"})

    def open(self, path, width=1280, height=720, dark=False, phone=False):
        self.in_chrome(f"Services.prefs.setIntPref('layout.css.prefers-color-scheme.content-override', {0 if dark else 1});"
                       "Services.console.reset();"
                       "const w = Services.wm.getMostRecentWindow('navigator:browser');"
                       "if (!w.aspicSeen) { w.aspicSeen = [];"
                       "Services.obs.addObserver((s) => { const c = s.QueryInterface(Ci.nsIHttpChannel);"
                       "if (c.loadInfo.browsingContextID) w.aspicSeen.push(c.URI.spec); }, 'http-on-modify-request'); } w.aspicSeen.length = 0;")
        self.ask("WebDriver:Navigate", {"url": "about:blank"})
        inner = self.ask("WebDriver:ExecuteScript", {"script": "return [innerWidth - outerWidth, innerHeight - outerHeight]", "args": []})["value"]
        self.ask("WebDriver:SetWindowRect", {"width": width - inner[0], "height": height - inner[1]})
        self.ask("WebDriver:Navigate", {"url": f"file://{os.path.abspath(path)}#paused"})
        wait_for(self)

    def call(self, expression):
        script = ("const done = arguments[arguments.length - 1];"
                  f"(async () => {{ {expression} }})().then((value) => done({{ value }}), (error) => done({{ error: String(error) }}));")
        result = self.ask("WebDriver:ExecuteAsyncScript", {"script": script, "args": [], "sandbox": None})["value"]
        if "error" in result:
            raise Failure(result["error"])
        return result.get("value")

    @property
    def errors(self):
        found = self.in_chrome("return Services.console.getMessageArray().filter((m) => m instanceof Ci.nsIScriptError)"
                               ".filter((m) => m.sourceName.startsWith('file:')).map((m) => m.errorMessage)")
        # What the driver of the graphics card says of itself is no fault of the page's.
        return [text for text in found if "WEBGL_debug_renderer_info" not in text]

    @property
    def requests(self):
        return self.in_chrome("return Services.wm.getMostRecentWindow('navigator:browser').aspicSeen")

    def actions(self, actions):
        self.ask("WebDriver:PerformActions", {"actions": actions})
        self.ask("WebDriver:ReleaseActions")

    def key(self, key):
        value = self.keys.get(key, key)
        self.actions([{"type": "key", "id": "k", "actions": [{"type": "keyDown", "value": value}, {"type": "keyUp", "value": value}]}])

    def drag(self, from_, to):
        move = lambda x, y: {"type": "pointerMove", "x": round(x), "y": round(y), "duration": 50}
        self.actions([{"type": "pointer", "id": "m", "parameters": {"pointerType": "mouse"},
                       "actions": [move(*from_), {"type": "pointerDown", "button": 0}, move(*to), {"type": "pointerUp", "button": 0}]}])

    def touch(self, fingers):
        """Fingers from … to [((x, y), (x, y)), …], all at once, in three steps."""
        move = lambda x, y, duration: {"type": "pointerMove", "x": round(x), "y": round(y), "duration": duration}
        steps = [on_the_way(fingers, step / 3) for step in range(4)]
        self.actions([{"type": "pointer", "id": f"finger{i}", "parameters": {"pointerType": "touch"},
                       "actions": [move(*steps[0][i], 0), {"type": "pointerDown", "button": 0}, *(move(*places[i], 50) for places in steps[1:]),
                                   {"type": "pointerUp", "button": 0}]} for i in range(len(fingers))])

    def wheel(self, at, down):
        self.actions([{"type": "wheel", "id": "w", "actions": [{"type": "scroll", "x": round(at[0]), "y": round(at[1]), "deltaX": 0, "deltaY": down, "duration": 0}]}])

    def screenshot(self):
        return base64.b64decode(self.ask("WebDriver:TakeScreenshot", {"full": False})["value"])

    def close(self):
        end(self.process)
        self.socket.close()
        self.display.terminate()
        self.display.wait()
        shutil.rmtree(self.profile, ignore_errors=True)


def start(kind):
    """A browser of that kind; None where none is installed."""
    if kind is Firefox and not shutil.which("Xvfb"):
        return None
    for program in kind.programs:
        if shutil.which(program):
            return kind(shutil.which(program))
    return None
