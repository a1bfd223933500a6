"""What all attacks share: the program run under limits and with damage, and what every run must keep to."""
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time

OK, DIFFERS, USAGE, SCENE, DEVICE, DIVERGED, IO, INTERRUPTED = 0, 1, 2, 3, 4, 5, 6, 130
TINY = ["--set", "cube[0].particles-per-edge=2"]


class Run:
    """A finished run. `code` is negative where a signal ended it."""

    def __init__(self, code, out, err, seconds, words):
        self.code, self.out, self.err, self.seconds, self.words = code, out, err, seconds, words

    def __str__(self):
        return f"{' '.join(map(shown, self.words))}: exit {self.code} after {self.seconds:.1f} s: {shown(self.err[:400])}"


def shown(text):
    return (text if isinstance(text, str) else text.decode("utf-8", "backslashreplace"))[:300]


class Attack:
    """One suite: counts runs, collects what is wrong, and says so at the end."""

    def __init__(self, program, shim=None, thorough=False):
        self.program, self.shim, self.thorough = program, shim, thorough
        self.runs, self.wrong, self.started = 0, [], time.monotonic()
        self.codes = {}
        self.room = tempfile.TemporaryDirectory(prefix="aspic-attack-")
        self.directory = self.room.name

    def path(self, name):
        return os.path.join(self.directory, name)

    def fresh(self):
        """An empty directory."""
        return tempfile.mkdtemp(dir=self.directory)

    def blame(self, sentence):
        if len(self.wrong) < 200:
            self.wrong.append(sentence)

    def require(self, kept, sentence):
        if not kept:
            self.blame(sentence)
        return kept

    def run(self, *words, env=None, cwd=None, limits=(), close=(), stdin=b"", stdout=None, stderr=None, timeout=60,
            before=None):
        """`limits`: (RLIMIT_…, value) pairs; `close`: descriptors that the program starts without."""
        environment = dict(os.environ)
        environment.pop("LD_PRELOAD", None)
        for name, value in (env or {}).items():
            if value is None:
                environment.pop(name, None)
            else:
                environment[name] = value

        def prepare():
            for kind, value in limits:
                resource.setrlimit(kind, (value, value))
            if before:
                before()
            for descriptor in close:
                os.close(descriptor)

        self.runs += 1
        started = time.monotonic()
        child = subprocess.Popen([self.program, *words], env=environment, cwd=cwd or self.directory, preexec_fn=prepare,
                                 stdin=subprocess.PIPE, stdout=stdout or subprocess.PIPE, stderr=stderr or subprocess.PIPE)
        try:
            out, err = child.communicate(stdin, timeout=timeout)
            code = child.returncode
        except subprocess.TimeoutExpired:
            child.kill()
            out, err = child.communicate()
            code = "hang"
        self.codes[code] = self.codes.get(code, 0) + 1
        return Run(code, out or b"", err or b"", time.monotonic() - started, words)

    def judge(self, run, codes, note=""):
        """No run may end by a signal, by the C++ library's last words or without a sentence."""
        good = run.code in codes
        if b"terminate called" in run.err or b"what():" in run.err:
            good = False
        # 127: the system's loader did not get as far as the program. Drivers may speak first.
        if good and run.code not in (OK, 127):
            good = b"aspic: " in run.err and len(run.err) > 20
        if good and not harmless(run.err):
            good = False
            note += " (control characters in a message)"
        return self.require(good, f"{note}: {run}, allowed {sorted(codes)}")

    def leaves_nothing(self, directory, note):
        left = [n for n in all_files(directory) if os.path.basename(n).startswith(".aspic-")]
        return self.require(not left, f"{note}: left behind {left}")

    def finish(self):
        for sentence in self.wrong:
            print("WRONG", sentence)
        codes = ", ".join(f"{n} × {c}" for c, n in sorted(self.codes.items(), key=lambda item: -item[1]))
        print(f"{self.runs} runs ({codes}), {len(self.wrong)} wrong, {time.monotonic() - self.started:.0f} s")
        self.room.cleanup()
        sys.exit(1 if self.wrong else 0)


def harmless(message):
    """Whether a terminal takes a message as text: UTF-8 without control characters or marks that turn it around."""
    try:
        text = message.decode("utf-8")
    except UnicodeDecodeError:
        return False
    for c in text:
        o = ord(c)
        if (o < 0x20 and c != "\n") or 0x7F <= o < 0xA0 or 0x202A <= o <= 0x202E or 0x2066 <= o <= 0x2069 or o in (0x200E, 0x200F):
            return False
    return True


def all_files(directory):
    return sorted(os.path.join(root, name) for root, _, names in os.walk(directory) for name in names)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def write(path, content):
    with open(path, "wb") as file:
        file.write(content if isinstance(content, bytes) else content.encode())
    return path


def fnv1a(data):
    value = 0xCBF29CE484222325
    for byte in data:
        value = ((value ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return value


def hash_in(run):
    for line in run.out.decode().splitlines():
        if line.startswith("state hash"):
            return line.split()[-1]
    return None


def main(suites):
    """attack suite: `SUITE.py PROGRAM SHIM NAME [--thorough]`."""
    program, shim, name = sys.argv[1:4]
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    random.seed(15)
    attack = Attack(os.path.abspath(program), os.path.abspath(shim) if shim != "-" else None, "--thorough" in sys.argv)
    suites[name](attack)
    attack.finish()
