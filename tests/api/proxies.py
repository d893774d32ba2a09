# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples of docker/ tried: a server behind nginx under a path, and behind Caddy, both over TLS on this machine."""

import http.client
import json
import os
import shutil
import socket
import ssl
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROGRAM, SOURCES = os.environ.get("EASEOFF", "./easeoff"), Path(os.environ.get("SOURCES", "."))
TOKEN = "sesame-seed-sesame-seed"
CLIENT, SPOOFED = "127.0.0.2", "203.0.113.9"
count = failed = 0


def ok(good, what):
    global count, failed
    count += 1
    failed += not good
    print(f"{'ok' if good else 'not ok'} {count} - {what}", flush=True)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_for(port):
    for _ in range(300):
        try:
            socket.create_connection(("127.0.0.1", port), 1).close()
            return
        except OSError:
            time.sleep(0.1)
    raise OSError(f"nobody listens at {port}")


class Server:
    def __init__(self, folder, *options):
        self.log = open(folder / "log", "w+b")
        command = [PROGRAM, "serve", "--listen", "127.0.0.1:0", "--data", str(folder / "data"), "--trusted-proxies", "127.0.0.1"]
        environment = os.environ | {"EASEOFF_TOKEN": TOKEN}
        self.process = subprocess.Popen([*command, *options], stdout=subprocess.PIPE, stderr=self.log, env=environment)
        self.port = int(self.process.stdout.readline().decode().split(":")[3].rstrip("/\n"))

    def clients(self):
        """Who the log says has asked; it is written a little later."""
        time.sleep(0.5)
        lines = [json.loads(line) for line in (Path(self.log.name)).read_text().splitlines()]
        return [line["client"] for line in lines if line.get("event") == "request"]

    def end(self):
        self.process.terminate()
        self.process.wait()
        self.process.stdout.close()
        self.log.close()


def connect(port, source=CLIENT):
    trusting = ssl._create_unverified_context()
    return http.client.HTTPSConnection("localhost", port, timeout=20, context=trusting, source_address=(source, 0))


def ask(port, method, path, document=None, **headers):
    connection = connect(port)
    body = document if isinstance(document, bytes) or document is None else json.dumps(document)
    headers = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, body, headers)
    reply = connection.getresponse()
    data = reply.read()
    connection.close()
    return reply.status, reply.headers, data


def try_it(name, server, port, base):
    api = base + "/api/v1"
    own = {"Authorization": f"Bearer {TOKEN}", "Content_Type": "application/json"}
    status, headers, _ = ask(port, "GET", api + "/health")
    ok(status == 200, f"{name}: it answers")
    status, headers, _ = ask(port, "POST", api + "/session", {"token": TOKEN}, Content_Type="application/json", Origin=f"https://localhost:{port}")
    cookie = headers.get("Set-Cookie", "")
    ok(status == 204 and "Secure" in cookie and "HttpOnly" in cookie and f"Path={base or ''}/" in cookie, f"{name}: the cookie is Secure and below the path: {cookie.split(';', 1)[-1]}")
    status, _, _ = ask(port, "GET", api + "/designs", Cookie=cookie.split(";")[0])
    ok(status == 200, f"{name}: and is good for a session")
    design = json.loads(ask(port, "GET", api + "/examples/paper-case-a", **own)[2])
    status, headers, _ = ask(port, "POST", api + "/designs", design, **own)
    ok(status == 201 and headers["Location"].startswith(api + "/designs/"), f"{name}: Location is below the path: {status}, {headers['Location']}")
    status, _, _ = ask(port, "GET", headers["Location"], **own)
    ok(status == 200, f"{name}: and leads there")
    status, _, _ = ask(port, "POST", api + "/designs", design, Origin="https://elsewhere.example", **own)
    ok(status == 403, f"{name}: no page of another site")
    ask(port, "GET", api + "/designs", X_Forwarded_For=SPOOFED, **own)
    seen = server.clients()
    ok(seen and set(seen) == {CLIENT}, f"{name}: the client is who he is, whatever he says: {sorted(set(seen))}")
    direct = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20, source_address=("127.0.0.3", 0))
    direct.request("GET", api + "/health", headers={"X-Forwarded-For": SPOOFED, "X-Forwarded-Proto": "https"})
    direct.getresponse().read()
    direct.close()
    ok(server.clients()[-1] == "127.0.0.3", f"{name}: somebody else is no proxy: {server.clients()[-1]}")
    listen_for_events(name, port, api, own, design)
    upload(name, port, api)


def listen_for_events(name, port, api, own, design):
    stream = connect(port)
    stream.request("GET", api + "/events", headers={"Authorization": own["Authorization"]})
    reply = stream.getresponse()
    begun = time.time()
    status, _, _ = ask(port, "POST", api + "/jobs", {"kind": "prepare", "design": design | {"resolution": {"layers": 6, "flank_rows": 4}}}, **own)
    line = b""
    while not line.startswith(b"data:"):
        line = reply.readline()
    ok(status == 202 and time.time() - begun < 5, f"{name}: an event comes when it happens, after {time.time() - begun:.2f} s")
    stream.close()


def upload(name, port, api):
    """More than a proxy takes by itself (nginx: 1 MB)."""
    body = b'--xx\r\nContent-Disposition: form-data; name="file"; filename="a.csv"\r\n\r\n' + b"1;2;3\n" * 1000000 + b"\r\n--xx--\r\n"
    status, _, data = ask(port, "POST", api + "/measurements", body, Authorization=f"Bearer {TOKEN}", Content_Type="multipart/form-data; boundary=xx")
    ok(status == 422 and b"problems" in data, f"{name}: {len(body) >> 20} MB come through: {status}")


def behind_nginx(folder):
    port = free_port()
    server = Server(folder, "--base-path", "/easeoff")
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost", "-keyout", folder / "key", "-out", folder / "cert"], check=True, capture_output=True)
    example = (SOURCES / "docker/nginx.conf").read_text().replace("127.0.0.1:8080", f"127.0.0.1:{server.port}")
    places = "".join(f"{kind}_temp_path {folder}/{kind};\n" for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"))
    (folder / "nginx.conf").write_text(
        f"daemon off; pid {folder}/pid; error_log {folder}/error.log; worker_processes 1;\nevents {{ }}\nhttp {{\naccess_log off;\n{places}"
        f"server {{ listen 127.0.0.1:{port} ssl; ssl_certificate {folder}/cert; ssl_certificate_key {folder}/key;\n{example}}} }}\n"
    )
    proxy = subprocess.Popen(["nginx", "-e", folder / "error.log", "-p", folder, "-c", folder / "nginx.conf"])
    return server, proxy, port, "/easeoff"


def behind_caddy(folder):
    port = free_port()
    server = Server(folder)
    example = (SOURCES / "docker/Caddyfile").read_text().replace("127.0.0.1:8080", f"127.0.0.1:{server.port}")
    example = example.replace("gears.example {", f"https://localhost:{port} {{\n    bind 127.0.0.1\n    tls internal")
    (folder / "Caddyfile").write_text("{\n    admin off\n    skip_install_trust\n    auto_https disable_redirects\n}\n" + example)
    environment = os.environ | {"XDG_DATA_HOME": str(folder), "XDG_CONFIG_HOME": str(folder), "HOME": str(folder)}
    with open(folder / "caddy.log", "wb") as log:
        proxy = subprocess.Popen(["caddy", "run", "--config", folder / "Caddyfile", "--adapter", "caddyfile"], stderr=log, stdout=log, env=environment)
    return server, proxy, port, ""


def main():
    ways = [way for way in ((behind_nginx, "nginx", "openssl"), (behind_caddy, "caddy")) if all(map(shutil.which, way[1:]))]
    if not ways:
        print("1..0 # SKIP neither nginx nor Caddy is here")
        return 0
    for begin, name, *_ in ways:
        with tempfile.TemporaryDirectory(prefix="easeoff-proxy-") as place:
            os.chmod(place, 0o755)
            server, proxy, port, base = begin(Path(place))
            try:
                wait_for(port)
                try_it(name, server, port, base)
            finally:
                proxy.terminate()
                proxy.wait()
                server.end()
    print(f"1..{count}")
    return 1 if failed else 0


sys.exit(main())
