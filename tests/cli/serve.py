"""The client of serve.sh: URL and what to try. Written from the text of the UM-Bridge protocol 1.0, with the standard
library and jsonschema alone."""
import base64
import http.client
import json
import socket
import sys
import time
import urllib.parse
from concurrent.futures import ThreadPoolExecutor

import jsonschema

url, what = sys.argv[1:3]
host, port = urllib.parse.urlparse(url).netloc.split(":")
BOOLEAN, INTEGER, NUMBER, TEXT = ({"type": kind} for kind in ("boolean", "integer", "number", "string"))


def record(**properties):
    return {"type": "object", "properties": properties, "required": list(properties), "additionalProperties": False}


def array(items, least=1):
    return {"type": "array", "items": items, "minItems": least}


SHAPES = {
    "/Info": record(protocolVersion=NUMBER, models=array(TEXT)),
    "/ModelInfo": record(support=record(Evaluate=BOOLEAN, Gradient=BOOLEAN, ApplyJacobian=BOOLEAN, ApplyHessian=BOOLEAN)),
    "/InputSizes": record(inputSizes=array(INTEGER)),
    "/OutputSizes": record(outputSizes=array(INTEGER)),
    "/Evaluate": record(output=array(array(NUMBER))),
}
ERROR = record(error=record(type=TEXT, message=TEXT))


def ask(method, path, body=None, headers={}, code=200, error=None):
    """The JSON of the answer, whose status, shape and type of error are checked."""
    connection = http.client.HTTPConnection(host, int(port), timeout=120)
    text = body if body is None or isinstance(body, (str, bytes)) else json.dumps(body)
    connection.request(method, path, text, dict(headers))
    answer = connection.getresponse()
    raw = answer.read()
    connection.close()
    assert answer.status == code, (path, body, answer.status, raw)
    if method == "HEAD":
        return None
    assert answer.getheader("Content-Type") == "application/json"
    value = json.loads(raw)
    if error:
        jsonschema.validate(value, ERROR)
        assert value["error"]["type"] == error, (path, body, value)
        return value["error"]["message"]
    if path in SHAPES:
        jsonschema.validate(value, SHAPES[path])
    return value


def evaluate(name, vector, **config):
    body = {"name": name, "input": [vector]}
    if config:
        body["config"] = config
    return ask("POST", "/Evaluate", body)["output"]


def wrong(body, code=400, error="InvalidInput", path="/Evaluate", **more):
    return ask("POST", path, body, code=code, error=error, **more)


def grid(path):
    """Inputs (in the order of the campaign) and rows of the points that `clast run` made."""
    rows = [json.loads(line) for line in open(path)]
    return [([row["threshold_strain"], row["threshold_angle"], row["grain_young_modulus"]], row) for row in rows]


def check_grid(path, **config):
    points = grid(path)
    with ThreadPoolExecutor(8) as pool:  # all at once: every answer must belong to its own request
        outputs = list(pool.map(lambda point: evaluate("disc", point[0], statistic=["mean", "sd", "se", "hw95"],
                                                       results=["largest_fraction", "fragment_count"], **config), points))
    for (vector, row), output in zip(points, outputs):
        for statistic, numbers in zip(("mean", "sd", "se", "hw95"), output):
            for result, number in zip(("largest_fraction", "fragment_count"), numbers):
                expected = row[f"{result}_{statistic}"]
                assert abs(number - expected) <= 1e-6 * abs(expected), (vector, statistic, result, number, expected)
    assert len(points) == 8 and len({json.dumps(output) for output in outputs}) == 8


def own_address():
    """The address at which other machines reach this one, or None. Its name need not have one. Nothing is sent."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))
        except OSError:
            return None
        return None if probe.getsockname()[0].startswith("127.") else probe.getsockname()[0]


def protocol():
    name, vector = {"name": "disc"}, [0.02, 0.05, 1e9]
    assert ask("GET", "/Info") == {"protocolVersion": 1.0, "models": ["disc"]}
    ask("HEAD", "/Info")
    ask("HEAD", "/")
    told = ask("GET", "/")
    assert [row["name"] for row in told["inputs"]] == ["threshold.strain", "threshold.angle", "grain.young_modulus"]
    assert told["inputs"][2]["unit"] == "Pa"
    assert ask("POST", "/ModelInfo", name)["support"] == {"Evaluate": True, "Gradient": False, "ApplyJacobian": False,
                                                          "ApplyHessian": False}
    assert ask("POST", "/InputSizes", name)["inputSizes"] == [3]
    assert ask("POST", "/InputSizes", {**name, "config": {}})["inputSizes"] == [3]
    assert ask("POST", "/OutputSizes", name)["outputSizes"] == [1]
    config = {"statistic": ["mean", "se"], "results": ["largest_fraction", "fragment_count", "energy.kinetic"]}
    assert ask("POST", "/OutputSizes", {**name, "config": config})["outputSizes"] == [3, 3]
    assert ask("POST", "/OutputSizes", {**name, "config": {"replicate": 1}})["outputSizes"] == [1]

    # Evaluate: the means of `clast run`; seeds one by one have that mean; more seeds
    check_grid(sys.argv[3])
    assert evaluate("disc", vector) == evaluate("disc", vector, replicates=3)
    ones = [evaluate("disc", vector, replicate=r)[0][0] for r in range(3)]
    assert len(set(ones)) == 3 and abs(sum(ones) / 3 - evaluate("disc", vector)[0][0]) < 1e-15
    assert evaluate("disc", vector, replicates=5, statistic="mean") != evaluate("disc", vector)
    assert len(evaluate("disc", vector, statistic=["mean", "se"], results=["fragment_count"])) == 2
    # many requests for the same new run at once: one answer
    with ThreadPoolExecutor(8) as pool:
        same = list(pool.map(lambda _: evaluate("disc", [0.03, 0.1, 1e9], replicates=2)[0][0], range(16)))
    assert len(set(same)) == 1

    # errors of the protocol
    for path in ("/Evaluate", "/ModelInfo", "/InputSizes", "/OutputSizes", "/Gradient", "/ApplyJacobian", "/ApplyHessian"):
        assert "disc" in wrong({"name": "other"}, error="ModelNotFound", path=path)
        wrong({}, path=path)
        wrong("", path=path)
        wrong("{", path=path)
        wrong("[1]", path=path)
        wrong(b"\xff\xfe", path=path)
        wrong({"name": 3}, path=path)
        ask("GET", path, code=405, error="InvalidInput")
    ask("POST", "/Info", {}, code=405, error="InvalidInput")
    for path in ("/Gradient", "/ApplyJacobian", "/ApplyHessian"):
        wrong(name, error="UnsupportedFeature", path=path)
        wrong({**name, "input": [vector], "outWrt": 0, "inWrt": 0, "sens": [1.0]}, error="UnsupportedFeature", path=path)
    for path in ("/EvaluateShMem", "/TestShMem", "/evaluate", "/Info/", "/../etc/passwd"):
        wrong(name, code=404, error="UnsupportedFeature", path=path)
    for bad in (None, vector, [vector, vector], [vector + [1]], [[0.02, 0.0]], [["a", 0.05, 1e9]], [], [[]], {"a": 1}, [[None, 0.05, 1e9]]):
        wrong({**name, "input": bad})
    assert "threshold.strain" in wrong({**name, "input": [[-1, 0.05, 1e9]]})
    assert "threshold.angle" in wrong({**name, "input": [[0.02, 1e30, 1e9]]})
    wrong('{"name": "disc", "input": [[NaN, 0.05, 1e9]]}')
    wrong('{"name": "disc", "input": [[1e999, 0.05, 1e9]]}')
    wrong('{"name": "disc", "name": "disc", "input": [[0.02, 0.05, 1e9]]}')
    for config in ({"oops": 1}, {"replicates": 0}, {"replicates": 1.5}, {"replicates": 10001}, {"replicates": "3"}, {"replicate": -1},
                   {"replicate": 1, "replicates": 2}, {"replicate": 1, "statistic": "mean"}, {"statistic": "median"},
                   {"statistic": []}, {"statistic": ["mean"] * 5}, {"statistic": 1}, {"statistic": "sd", "replicates": 1}, {"level": 0},
                   {"results": []}, {"results": "largest_fraction"}, {"results": ["no_such"]}, {"results": [1]},
                   {"results": ["message"]}, [1], "mean"):
        for path in ("/Evaluate", "/OutputSizes"):
            wrong({**name, "input": [vector], "config": config}, path=path)
    # a result that has no value: not a number in JSON
    assert "strength" in wrong({**name, "input": [vector], "config": {"results": ["strength"]}}, code=500, error="InvalidOutput")

    # limits of size; pages of browsers
    with socket.create_connection((host, int(port))) as raw:  # refused before it is sent
        raw.sendall(b"POST /Evaluate HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n\r\n" % ((1 << 20) + 1))
        assert b" 413 " in raw.recv(65536).split(b"\r\n")[0]
    assert wrong(b" " * (1 << 20)).startswith("the body is no JSON")
    with socket.create_connection((host, int(port))) as raw:  # no length given: a chunk of 2 MiB
        raw.sendall(b"POST /Evaluate HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n200000\r\n" + b" " * (1 << 21)
                    + b"\r\n0\r\n\r\n")
        assert b" 413 " in raw.recv(65536).split(b"\r\n")[0]
    wrong({**name, "input": [vector]}, code=403, headers={"Origin": "http://example.org"})
    for called in ("example.org", f"example.org:{port}", "localhost.example.org", "127.0.0.1.example.org", "x" * 100):
        wrong({**name, "input": [vector]}, code=403, headers={"Host": called})
    for called in ("localhost", f"LOCALHOST:{port}", "127.0.0.1", "[::1]:1"):
        ask("GET", "/Info", headers={"Host": called})
    with socket.create_connection((host, int(port))) as raw:  # no HTTP
        raw.sendall(b"\x00\x01hello\r\n\r\n")
    with socket.create_connection((host, int(port))) as raw:  # goes away in the middle
        raw.sendall(b"POST /Evaluate HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n{")
    with socket.create_connection((host, int(port))) as raw:  # goes away while its run is computed
        body = json.dumps({**name, "input": [[0.041, 0.2, 1e9]]}).encode()
        raw.sendall(b"POST /Evaluate HTTP/1.1\r\nHost: localhost\r\nContent-Length: %d\r\n\r\n" % len(body) + body)
    assert evaluate("disc", vector)
    own = own_address()
    if own:
        try:
            socket.create_connection((own, int(port)), timeout=2)
            raise SystemExit(f"reached at {own}")
        except OSError:
            pass


def again():
    check_grid(sys.argv[3])
    assert evaluate("disc", [0.02, 0.05, 1e9])


def slow():
    begin = time.time()
    with ThreadPoolExecutor(2) as pool:
        waits = pool.submit(wrong, {"name": "long", "input": [[0.02]]}, 503, "Unavailable")
        time.sleep(0.2)
        assert time.time() - begin < 1 and ask("GET", "/Info")  # others are answered meanwhile
        assert "the same request finds them" in waits.result()


def pipelined():
    """Requests sent together, a long header and readers that stop are served at once, not one in 0.1 s."""
    begin = time.time()
    get = b"GET /Info HTTP/1.1\r\nHost: localhost\r\n\r\n"
    silent = [socket.create_connection((host, int(port))) for _ in range(20)]
    for one in silent:
        one.sendall(get[:7])
    with socket.create_connection((host, int(port)), timeout=60) as one:
        one.sendall(get * 100 + get[:-2] + b"X-Pad: " + 25000 * b"a" + b"\r\n\r\n")
        received = b""
        while received.count(b"200 OK") < 101:
            piece = one.recv(1 << 16)
            assert piece, received[-300:]
            received += piece
    assert time.time() - begin < 5, time.time() - begin


def token():
    path, given = "/Info", sys.argv[3]
    basic = lambda word: {"Authorization": "Basic " + base64.b64encode(f"any:{word}".encode()).decode()}
    bearer = lambda word: {"Authorization": f"Bearer {word}"}
    assert ask("GET", path, headers=bearer(given)) == ask("GET", path, headers=basic(given))
    evaluation = {"name": "disc", "input": [[0.02, 0.05, 1e9]], "config": {"replicates": 1}}
    assert ask("POST", "/Evaluate", evaluation, headers=basic(given))["output"]
    for headers in ({}, *(form(word) for form in (bearer, basic) for word in ("", given[:-1], given + "x", given.upper())), {"Authorization": given}):
        for method, place, body in (("GET", path, None), ("POST", "/Evaluate", evaluation)):
            assert "token" in ask(method, place, body, headers=headers, code=401, error="InvalidInput")


def hopeless():
    assert "0 of 1 runs" in wrong({"name": "long", "input": [[0.02]]}, code=500, error="InvalidOutput")
    assert "0 of 1 runs" in wrong({"name": "long", "input": [[0.02]]}, code=500, error="InvalidOutput")  # not tried again


{"protocol": protocol, "again": again, "slow": slow, "hopeless": hopeless, "pipelined": pipelined,
 "token": token}[what]()
