"""A good client keeps a force on a simulated device while hostile ones attack the server: the server stays up, its
memory does not grow by more than 64 MiB, ticks and force hold. Short in ./test; --seconds 10 --report for figures.

Usage: hostile_client_test.py --server trocar-hapticd --schema FOLDER [--seconds S] [--report]
"""
import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
# The address sanitizer keeps freed memory for some time.
MOST_GROWTH_KB = (512 if "ASAN_OPTIONS" in os.environ else 64) * 1024
PATIENCE_S = 60.0


def parse_arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("--server", help="trocar-hapticd")
    parser.add_argument("--schema", required=True, help="folder of `flatc --python --gen-object-api`")
    parser.add_argument("--seconds", type=float, default=1.0, help="of each attack")
    parser.add_argument("--report", action="store_true", help="print what was measured")
    parser.add_argument("--attack", help="run one attack in this process: NAME")
    parser.add_argument("--socket")
    return parser.parse_args()


arguments = parse_arguments()
try:
    import flatbuffers  # noqa: F401
except ImportError:
    print("skipped: python3-flatbuffers is not installed")
    sys.exit(SKIPPED)
sys.path.insert(0, arguments.schema)
import attacks  # noqa: E402
from link_client import Client, WHAT, load_scene, pose, set_parameters, simple, wire  # noqa: E402

COMMANDS = wire.SimpleCommandNumber.SimpleCommandNumber
MODE, FAULT = wire.GateMode.GateMode, wire.GateFault.GateFault
# The layered patient: the skin is the plane y = -45 mm, the body lies beyond it. The room stands over the entry.
ROOM = pose([0, 1, 0, 0, 0, -1, -1, 0, 0], [0.0, -175.0, 0.0])


def needle_at(depth_mm):
    """Straight down, the tip so deep below the skin."""
    return pose([1, 0, 0, 0, 0, 1, 0, -1, 0], [0.0, -45.0 + depth_mm, 0.0])


def scene(patient="layers-liver"):
    return load_scene(patient, ROOM)


class Server:
    def __init__(self, folder):
        self.path = os.path.join(folder, "needle")
        self.log = open(os.path.join(folder, "log"), "w+")
        self.process = subprocess.Popen(
            [arguments.server, "--endpoint", "ipc://" + self.path, "--priority", "0", "--flight-records", folder],
            stdout=self.log, stderr=self.log)
        end = time.monotonic() + PATIENCE_S
        while not os.path.exists(self.path):
            self.check_alive()
            assert time.monotonic() < end, "the server made no socket"
            time.sleep(0.01)

    def check_alive(self):
        if self.process.poll() is None:
            return
        self.log.seek(0)
        raise AssertionError(f"the server ended with {self.process.returncode}:\n{self.log.read()[-2000:]}")

    def memory_kb(self, field):
        with open(f"/proc/{self.process.pid}/status") as status:
            return next(int(line.split()[1]) for line in status if line.startswith(field + ":"))

    def begin_peak(self):
        with open(f"/proc/{self.process.pid}/clear_refs", "w") as refs:
            refs.write("5")

    def stop(self):
        """SIGTERM; how long it took."""
        begin = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(PATIENCE_S)
        return time.monotonic() - begin


def force_n(client):
    """On the device, without the stylus' weight."""
    sample, vector = client.sample, wire.Vec3.Vec3
    written, weight = sample.DeviceFN(vector()), sample.FWeightN(vector())
    parts = (written.X() - weight.X(), written.Y() - weight.Y(), written.Z() - weight.Z())
    return sum(part * part for part in parts) ** 0.5


def is_on(client):
    status = client.status
    return status is not None and status.GateMode() == MODE.On and status.Fault() == FAULT.None_


def name_of(enumeration, number):
    return next((name for name, value in vars(enumeration).items() if value == number), number)


def expect(condition, what):
    if not condition:
        raise AssertionError(what)


def press_on_skin(client):
    done, reply = client.ask(scene())
    expect(done, reply)
    client.set_hand(needle_at(-5.0), is_placed=True)
    done, reply = client.ask(simple(COMMANDS.Start))
    expect(done, reply)
    expect(client.wait(lambda: is_on(client)), "the gate does not open")
    depth = -5.0
    while depth < 15.0 and not (client.sample and force_n(client) > 0.5):  # the wall gives way under the needle
        depth += 0.02
        client.set_hand(needle_at(depth))
        time.sleep(0.002)
    expect(client.wait(lambda: client.sample and force_n(client) > 0.2), "no force at the skin")
    return settled_force_n(client)


def settled_force_n(client):
    """The force after a second of at most 0.02 N of change: the coupling of a loop that was slow has recovered."""
    end = time.monotonic() + PATIENCE_S
    while True:
        forces = []
        for _ in range(20):
            time.sleep(0.05)
            forces.append(force_n(client))
        if max(forces) - min(forces) < 0.02:
            return forces[-1]
        expect(time.monotonic() < end, f"the force does not settle: {min(forces)} to {max(forces)} N")


class Watch:
    """Memory, rate and force of the server from now on."""

    def __init__(self, server, client, force):
        self.server, self.client, self.force = server, client, force
        server.begin_peak()
        self.kb = server.memory_kb("VmRSS")
        self.ticks, self.missing = client.next_tick, client.missing
        self.begin = time.monotonic()
        self.lowest = self.highest = force
        client.on_sample = self.note

    def note(self, client):
        newest = force_n(client)
        self.lowest, self.highest = min(self.lowest, newest), max(self.highest, newest)

    def finish(self, name, extra=""):
        self.server.check_alive()
        client = self.client
        rate_hz = (client.next_tick - self.ticks) / (time.monotonic() - self.begin)
        # A client without a processor is silent, and its force fades; it comes back by itself.
        expect(client.wait(lambda: is_on(client)),
               f"{name}: no force, gate {name_of(MODE, client.status.GateMode())}, "
               f"fault {name_of(FAULT, client.status.Fault())}")
        expect(client.wait(lambda: abs(force_n(client) - self.force) < 0.1), f"{name}: the force is {force_n(client)} N, "
                                                                               f"it was {self.force} N")
        expect(self.highest < self.force + 0.1, f"{name}: the force rose to {self.highest} N from {self.force} N")
        expect(client.status.TicksDropped() == 0, f"{name}: {client.status.TicksDropped()} ticks dropped")
        growth_kb = self.server.memory_kb("VmHWM") - self.kb
        expect(growth_kb <= MOST_GROWTH_KB, f"{name}: memory grew by {growth_kb} kB")
        if arguments.report:
            print(f"{name:32} peak +{growth_kb / 1024:5.1f} MiB  {rate_hz:6.1f} Hz  force {self.lowest:.3f} to "
                  f"{self.highest:.3f} N  {client.missing - self.missing} ticks missing  {extra}", flush=True)


def run_attack(name, server):
    command = [sys.executable, "-B", os.path.abspath(__file__), "--schema", arguments.schema, "--attack", name, "--socket",
               server.path, "--seconds", str(arguments.seconds)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=arguments.seconds + PATIENCE_S)
    expect(done.returncode == 0, f"{name}: {done.stderr}")
    return done.stdout.strip()


def oversized_parameters(server, client, force):
    """Large parameters of the client in control itself, faster than they can be taken: a scene is being built meanwhile,
    and refused at its end because it has another hash."""
    slow = load_scene("layers-liver", ROOM, patientHash="another")
    client.ask(slow)
    watch = Watch(server, client, force)
    count = 12 if arguments.seconds < 5.0 else 60
    requests = [client.command(slow)]
    requests += [client.command(set_parameters(*[("x" * 200_000, "k", 0.5)] * 3)) for _ in range(count)]
    client.wait(lambda: all(request in client.replies for request in requests) or client.is_ended)
    unanswered = [request for request in requests if request not in client.replies]
    expect(not unanswered, f"no reply to {unanswered} of {requests}; connection closed: {client.is_ended}; "
                           f"refusals: {client.refusals[-3:]}; {client.missing} ticks missing")
    replies = [client.replies[request] for request in requests]
    refused = sum("busy" in reply for _, reply in replies)
    expect(not any(done for done, _ in replies[1:]), "nonsense was taken as parameters")
    watch.finish("oversized parameters", f"{refused} of {count} answered with busy")


def malformed_commands(client):
    done, reply = client.ask(load_scene("layers-liver", pose([2, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0])))
    expect(not done and "rotation" in reply, reply)
    done, reply = client.ask(simple(200))
    expect(not done and "enumeration" in reply, reply)


def hostile_folders(server, client, force, folder):
    """A patient folder whose file never ends, or never begins."""
    watch = Watch(server, client, force)
    for name in ("fifo", "zero"):
        patient = os.path.join(folder, name)
        os.mkdir(patient)
        target = os.path.join(patient, "patient.toml")
        if name == "fifo":
            os.mkfifo(target)
        else:
            os.symlink("/dev/zero", target)
        done, reply = client.ask(scene(patient))
        expect(not done, f"{name} was loaded as a patient")
    watch.finish("FIFO and /dev/zero folders")


def main():
    if arguments.attack:
        print(getattr(attacks, arguments.attack)(arguments.socket, arguments.seconds))
        return
    with tempfile.TemporaryDirectory() as folder:
        server = Server(folder)
        try:
            client = Client(server.path)
            expect(client.welcome.HasControl(), "no control")
            force = press_on_skin(client)
            malformed_commands(client)
            for attack in attacks.ALL:
                watch = Watch(server, client, force)
                opened = run_attack(attack.__name__, server)
                watch.finish(attack.__name__.replace("_", " "), f"{opened} connections")
            oversized_parameters(server, client, force)
            hostile_folders(server, client, force, folder)
            client.goodbye()
            took_s = server.stop()
            expect(server.process.returncode == 0, f"the server ended with {server.process.returncode}")
            if arguments.report:
                print(f"SIGTERM to end: {took_s:.2f} s")
        finally:
            if server.process.poll() is None:
                server.process.kill()
            server.process.wait()


main()
