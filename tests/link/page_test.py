"""docs/link.md against the schema: the page's bytes are a Hello, and every enumeration it names exists."""
import re
import sys

SKIPPED = 77
page_path, schema = sys.argv[1:3]
try:
    import flatbuffers  # noqa: F401
except ImportError:
    print("skipped: python3-flatbuffers is not installed")
    sys.exit(SKIPPED)
sys.path.insert(0, schema)
import link_client  # noqa: E402
from link_client import wire  # noqa: E402

with open(page_path) as file:
    page = file.read()

lines = re.findall(r"^[0-9a-f]{2}  ((?:[0-9a-f]{2} ?)+)$", page, re.MULTILINE)
printed = bytes.fromhex(" ".join(lines))
encoded = link_client.encode(0, 0, link_client.hello_body("demo", True), link_client.CLIENT_BODY.Hello)
assert printed == encoded, f"the page has {printed.hex()}, the encoder makes {encoded.hex()}"
message = wire.ClientMessage.ClientMessageT.InitFromObj(wire.ClientMessage.ClientMessage.GetRootAs(printed, 0))
assert message.version == wire.Version.Version.Current
assert f"00 {len(encoded):02X} <{len(encoded)} bytes" in page, "the frame's size in the example"
ready = link_client.ready(b"")
assert f"04 {ready[1]:02X} 05" in page, "the size of READY in the example"

enumerations = {"Version", "SimpleCommandNumber", "MessageBytes", "TextBytes", "MostItems", "MostClients", "RateLimit", "Period"}
used = set(re.findall(r"`([A-Z]\w+)\.([A-Z]\w+)`", page))
assert {name for name, _ in used} <= enumerations
for name, member in used:
    module = __import__(f"trocar.wire.{name}", fromlist=[name])
    assert hasattr(getattr(module, name), member), f"{name}.{member} is not in the schema"

import trocar.wire.SimpleCommandNumber  # noqa: E402

for name, number in vars(trocar.wire.SimpleCommandNumber.SimpleCommandNumber).items():
    if not name.startswith("_"):
        assert re.search(rf"\b{number} `{name}`", page), f"command {number} {name} is not in the table"
