"""A client of trocar-hapticd, written from docs/link.md and src/device/link/messages.fbs alone.
Standard library and flatbuffers."""
import os
import select
import socket
import struct
import threading
import time

import flatbuffers
import trocar.wire.ClientBody
import trocar.wire.ClientMessage
import trocar.wire.Command
import trocar.wire.GateFault
import trocar.wire.GateMode
import trocar.wire.Goodbye
import trocar.wire.Hand
import trocar.wire.HandTarget
import trocar.wire.Heartbeat
import trocar.wire.Hello
import trocar.wire.LoadScene
import trocar.wire.MotionDrive
import trocar.wire.Needle
import trocar.wire.Period
import trocar.wire.Pong
import trocar.wire.Pose
import trocar.wire.Refusal
import trocar.wire.Reply
import trocar.wire.ServerBody
import trocar.wire.ServerMessage
import trocar.wire.SetParameters
import trocar.wire.SimpleCommand
import trocar.wire.SimpleCommandNumber
import trocar.wire.StateBatch
import trocar.wire.TissueSetting
import trocar.wire.Vec3
import trocar.wire.Version
import trocar.wire.Welcome
import trocar.wire.What

wire = trocar.wire
CLIENT_BODY = wire.ClientBody.ClientBody
SERVER_BODY = wire.ServerBody.ServerBody
WHAT = wire.What.What

# ZMTP 3: the bits of a frame's flags.
MORE, LONG, COMMAND = 1, 2, 4


def frame(body, flags=0):
    """One ZMTP frame."""
    if len(body) > 255:
        return struct.pack(">BQ", flags | LONG, len(body)) + body
    return struct.pack(">BB", flags, len(body)) + body


def metadata(name, value):
    return bytes([len(name)]) + name + struct.pack(">I", len(value)) + value


def greeting(mechanism=b"NULL"):
    return b"\xff" + bytes(8) + b"\x7f" + bytes([3, 0]) + mechanism.ljust(20, b"\0") + bytes(32)


def ready(routing_id):
    return frame(b"\x05READY" + metadata(b"Socket-Type", b"DEALER") + metadata(b"Identity", routing_id), COMMAND)


class Closed(Exception):
    """The server closed the connection."""


class Connection:
    """A DEALER with the mechanism NULL over a Unix socket."""

    def __init__(self, path, timeout_s=30.0):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(timeout_s)
        self.socket.connect(path)
        self.pending = b""
        self.socket.sendall(greeting())
        if self._take(64)[:1] != b"\xff":
            raise Closed("not ZMTP")
        self.socket.sendall(ready(b"py" + os.urandom(14)))
        flags, body = self._frame()
        if not flags & COMMAND or not body.startswith(b"\x05READY"):
            raise Closed("no READY")

    def close(self):
        self.socket.close()

    def send(self, body, flags=0):
        self.socket.sendall(frame(body, flags))

    def receive(self):
        """The next message's body."""
        while True:
            flags, body = self._frame()
            if not flags & COMMAND:
                return body

    def is_readable(self, wait_s=0.0):
        return bool(self.pending) or bool(select.select([self.socket], [], [], wait_s)[0])

    def _frame(self):
        flags = self._take(1)[0]
        size = struct.unpack(">Q", self._take(8))[0] if flags & LONG else self._take(1)[0]
        return flags, self._take(size)

    def _take(self, count):
        while len(self.pending) < count:
            more = self.socket.recv(1 << 16)
            if not more:
                raise Closed("the server closed the connection")
            self.pending += more
        taken, self.pending = self.pending[:count], self.pending[count:]
        return taken


def encode(session, sequence, body, body_type, version=None):
    message = wire.ClientMessage.ClientMessageT()
    message.version = wire.Version.Version.Current if version is None else version
    message.session, message.sequence, message.bodyType, message.body = session, sequence, body_type, body
    builder = flatbuffers.Builder(1024)
    builder.Finish(message.Pack(builder), file_identifier=b"TRCC")
    return bytes(builder.Output())


SERVER_BODIES = {getattr(SERVER_BODY, name): getattr(getattr(wire, name), name)
                 for name in ("Welcome", "StateBatch", "Reply", "Pong", "Refusal")}


class ServerMessage:
    """Read by the generated accessors: the object API of flatc 2.0 cannot read arrays in structs."""

    def __init__(self, data):
        if data[4:8] != b"TRCS":
            raise ValueError("not a server's message")
        root = wire.ServerMessage.ServerMessage.GetRootAs(data, 0)
        if root.Version() != wire.Version.Version.Current:
            raise ValueError(f"the server speaks version {root.Version()}")
        self.session, self.sequence, self.type = root.Session(), root.Sequence(), root.BodyType()
        self.body = SERVER_BODIES[self.type]()
        table = root.Body()
        self.body.Init(table.Bytes, table.Pos)


def decode(data):
    return ServerMessage(data)


def hello_body(name, wants_control):
    body = wire.Hello.HelloT()
    body.client, body.wantsControl = name, wants_control
    return body


def vec3(x, y, z):
    v = wire.Vec3.Vec3T()
    v.x, v.y, v.z = float(x), float(y), float(z)
    return v


def pose(rotation, position):
    p = wire.Pose.PoseT()
    p.rotation, p.position = [float(r) for r in rotation], vec3(*position)
    return p


def load_scene(patient, x_pw, **fields):
    needle = wire.Needle.NeedleT()
    needle.lengthMm, needle.radiusMm, needle.innerRadiusMm, needle.styletRadiusMm = 150.0, 0.635, 0.0, 0.0
    needle.youngGpa, needle.bevelRad, needle.bevelShare = 200.0, 0.35, 0.1
    scene = wire.LoadScene.LoadSceneT()
    scene.patient, scene.patientSeed, scene.tool, scene.needle = patient, 1, "needle", needle
    scene.forceModel, scene.seed, scene.xPw = "insertion", 1, x_pw
    motion = wire.MotionDrive.MotionDriveT()
    motion.periodS, motion.depth, motion.firstDepth = 4.0, [0.0] * 2, 1.0
    motion.holdS, motion.releaseS, motion.holdLimitS = -1.0, -1.0, 20.0
    scene.motion = motion
    for name, value in fields.items():
        setattr(scene, name, value)
    return scene, WHAT.LoadScene


def set_parameters(*settings, **options):
    """Settings are (row, key, value); a value of None: never."""
    body = wire.SetParameters.SetParametersT()
    body.tissues = []
    for row, key, value in settings:
        setting = wire.TissueSetting.TissueSettingT()
        setting.row, setting.key, setting.value = row, key, value
        body.tissues.append(setting)
    for name, value in options.items():
        setattr(body, name, value)
    return body, WHAT.SetParameters


def simple(number):
    body = wire.SimpleCommand.SimpleCommandT()
    body.command = number
    return body, WHAT.SimpleCommand


class Client:
    """Says Hello, beats at 100 Hz in a thread of its own, and keeps what the server tells."""

    def __init__(self, path, name="python", wants_control=True):
        self.connection = Connection(path)
        self.lock = threading.Lock()
        self.news = threading.Condition()
        self.sequence = self.request = self.ticks = self.missing = 0
        self.replies, self.refusals = {}, []
        self.sample = self.status = self.welcome = self.pong = self.next_tick = None
        self.session = 0
        self.on_sample = None  # called with the newest sample of every batch
        self.is_ended = False
        self.connection.send(encode(0, 0, hello_body(name, wants_control), CLIENT_BODY.Hello))
        while self.session == 0:
            self._take(decode(self.connection.receive()))
        self.threads = [threading.Thread(target=work, daemon=True) for work in (self._beat, self._read)]
        for thread in self.threads:
            thread.start()

    def ask(self, what_and_type, patience_s=60.0):
        """Sends a command and waits for its reply: (is done, text)."""
        request = self.command(what_and_type)
        if not self.wait(lambda: request in self.replies, patience_s):
            raise TimeoutError("no reply")
        return self.replies[request]

    def command(self, what_and_type):
        body = wire.Command.CommandT()
        body.what, body.whatType = what_and_type
        self.request += 1
        body.request = self.request
        self._send(body, CLIENT_BODY.Command)
        return body.request

    def set_hand(self, x_pn, is_placed=False):
        hand = wire.Hand.HandT()
        hand.xPn, hand.vP, hand.wP, hand.serverTimeS = x_pn, vec3(0, 0, 0), vec3(0, 0, 0), 0.0
        hand.stiffnessNPerMm, hand.dampingNsPerMm, hand.massKg = 0.6, 0.012, 0.15
        hand.turningNmmPerRad, hand.turningDampingNmmsPerRad, hand.inertiaKgMm2 = 300.0, 8.0, 50.0
        hand.buttons, hand.holdsTip, hand.isHeld, hand.isRigid, hand.isPlaced = 0, True, True, False, is_placed
        body = wire.HandTarget.HandTargetT()
        body.hand = hand
        self._send(body, CLIENT_BODY.HandTarget)

    def wait(self, is_so, patience_s=60.0):
        with self.news:
            return self.news.wait_for(is_so, patience_s)

    def goodbye(self):
        self._send(wire.Goodbye.GoodbyeT(), CLIENT_BODY.Goodbye)
        self.is_ended = True
        self.connection.close()

    def _send(self, body, body_type):
        with self.lock:
            self.sequence += 1
            self.connection.send(encode(self.session, self.sequence, body, body_type))

    def _beat(self):
        while not self.is_ended:
            beat = wire.Heartbeat.HeartbeatT()
            beat.clientTimeS, beat.windowAgeS, beat.ticksReceived = time.monotonic(), 0.0, self.ticks
            try:
                self._send(beat, CLIENT_BODY.Heartbeat)
            except OSError:
                return
            time.sleep(wire.Period.Period.Heartbeat / 1000.0)

    def _read(self):
        try:
            while not self.is_ended:
                self._take(decode(self.connection.receive()))
        except (Closed, OSError):
            pass
        with self.news:
            self.is_ended = True
            self.news.notify_all()

    def _take(self, message):
        body = message.body
        with self.news:
            if message.type == SERVER_BODY.Welcome:
                self.session, self.welcome = body.Session(), body
            elif message.type == SERVER_BODY.Reply:
                self.replies[body.Request()] = (body.IsDone(), text(body.Text()))
            elif message.type == SERVER_BODY.Refusal:
                self.refusals.append(text(body.Text()))
            elif message.type == SERVER_BODY.Pong:
                self.pong = body
            elif message.type == SERVER_BODY.StateBatch:
                self._take_batch(body)
            self.news.notify_all()

    def _take_batch(self, batch):
        count = batch.SamplesLength()
        if count > 0:
            if self.next_tick is not None:
                self.missing += batch.FirstTick() - self.next_tick
            self.next_tick = batch.FirstTick() + count
            self.ticks += count
            self.sample = batch.Samples(count - 1)
            if self.on_sample is not None:
                self.on_sample(self)
        if batch.Status() is not None:
            self.status = batch.Status()


def text(value):
    return (value or b"").decode()
