"""What hostile programs of the same user do to a server's socket. Each runs in a process of its own for some seconds."""
import os
import resource
import socket
import struct
import time

import link_client
from link_client import CLIENT_BODY, COMMAND, LONG, MORE, Closed, Connection, encode, frame, hello_body


def repeat(path, seconds, attack):
    """Calls attack(connection, is_over) with new connections until the time is over; counts the connections."""
    end = time.monotonic() + seconds
    is_over = lambda: time.monotonic() > end
    count = 0
    while not is_over():
        connection = None
        try:
            connection = Connection(path, timeout_s=1.0)
            count += 1
            attack(connection, is_over)
        except (OSError, Closed):
            time.sleep(0.001)
        finally:
            if connection is not None:
                connection.close()
    return count


def say_hello(connection, wants_control=False, name="hostile"):
    connection.send(encode(0, 0, hello_body(name, wants_control), CLIENT_BODY.Hello))
    while True:
        message = link_client.decode(connection.receive())
        if message.type == link_client.SERVER_BODY.Welcome:
            return message.body.Session()


def flood_of_hellos(path, seconds):
    hello = frame(encode(0, 0, hello_body("flood", True), CLIENT_BODY.Hello)) * 100

    def attack(connection, is_over):
        while not is_over():
            connection.socket.sendall(hello)

    return repeat(path, seconds, attack)


def flood_of_garbage(path, seconds):
    def attack(connection, is_over):
        while not is_over():
            connection.send(os.urandom(200))

    return repeat(path, seconds, attack)


def flood_of_beats(path, seconds):
    """Of a watcher, well formed, as fast as the socket takes them; what the server sends is not read."""

    def attack(connection, is_over):
        session, sequence = say_hello(connection), 0
        while not is_over():
            sequence += 1
            beat = link_client.wire.Heartbeat.HeartbeatT()
            connection.send(encode(session, sequence, beat, CLIENT_BODY.Heartbeat))

    return repeat(path, seconds, attack)


def endless_multipart(path, seconds):
    part = frame(bytes(60000), MORE) + frame(b"", MORE) * 1000

    def attack(connection, is_over):
        while not is_over():
            connection.socket.sendall(part)

    return repeat(path, seconds, attack)


def endless_multipart_after_hello(path, seconds):
    part = frame(bytes(60000), MORE)

    def attack(connection, is_over):
        say_hello(connection)
        while not is_over():
            connection.socket.sendall(part)

    return repeat(path, seconds, attack)


def long_names(path, seconds):
    hello = encode(0, 0, hello_body("n" * 256 * 1024, True), CLIENT_BODY.Hello)

    def attack(connection, is_over):
        while not is_over():
            connection.send(hello)

    return repeat(path, seconds, attack)


def huge_frames(path, seconds):
    """Announces large messages after Hello and never ends them."""

    def attack(connection, is_over):
        say_hello(connection)
        connection.socket.sendall(struct.pack(">BQ", LONG, 1 << 20) + bytes((1 << 20) - 1))
        while not is_over():
            connection.receive()
        connection.socket.sendall(struct.pack(">BQ", LONG, 1 << 62))

    return repeat(path, seconds, attack)


def bad_handshakes(path, seconds):
    end = time.monotonic() + seconds
    count = 0
    while time.monotonic() < end:
        with socket.socket(socket.AF_UNIX) as bad:
            bad.settimeout(1.0)
            try:
                bad.connect(path)
                bad.sendall(os.urandom(64) if count % 2 else link_client.greeting() + frame(os.urandom(1000), COMMAND))
                bad.recv(100)
                count += 1
            except OSError:
                time.sleep(0.001)
    return count


def two_thousand_connections(path, seconds):
    """Connections that say nothing, held open until the end; those that the server closes are opened again."""
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = 2000 if hard == resource.RLIM_INFINITY else min(2000, hard - 100)
    resource.setrlimit(resource.RLIMIT_NOFILE, (wanted + 100, hard))
    held, opened = [], 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        connection = socket.socket(socket.AF_UNIX)
        connection.setblocking(False)
        try:
            connection.connect(path)
            held.append(connection)
            opened += 1
        except OSError:
            connection.close()
            time.sleep(0.001)
        if len(held) >= wanted:
            held.pop(0).close()
    return opened


ALL = [flood_of_hellos, flood_of_garbage, flood_of_beats, endless_multipart, endless_multipart_after_hello, long_names,
       huge_frames, bad_handshakes, two_thousand_connections]
