# SPDX-License-Identifier: GPL-3.0-or-later
"""HTTP to one service: requests, problems, form data and event streams, with the standard library alone."""

from __future__ import annotations

import json
import secrets
import urllib.error
import urllib.parse
import urllib.request
from dataclasses import dataclass
from email.message import Message
from typing import Any, BinaryIO, Iterator, Mapping, Sequence


class Problem(Exception):
    """What the service refused, with its reason (RFC 9457).

    status: of the reply. detail: the reason in a sentence. errors: every fault of the body, each with `pointer`, the
    JSON pointer of the key, and `detail`. document: the whole problem.
    """

    def __init__(self, status: int, document: Mapping[str, Any]):
        self.status = status
        self.document = document
        self.detail: str = document.get("detail") or document.get("title") or "no reason given"
        self.errors: Sequence[Mapping[str, Any]] = document.get("errors") or []
        faults = [f"{fault.get('pointer', '')}: {fault.get('detail', '')}" for fault in self.errors]
        super().__init__(f"{status}: " + "; ".join(faults or [self.detail]))


@dataclass(frozen=True)
class Reply:
    """A reply that is no problem. body: bytes as they came."""

    status: int
    headers: Message
    body: bytes

    @property
    def json(self) -> Any:
        return json.loads(self.body) if self.body else None

    @property
    def text(self) -> str:
        return self.body.decode("utf-8")


@dataclass(frozen=True)
class Event:
    """One event of a stream. id: its number, for Last-Event-ID; data: the document it carries."""

    id: str
    name: str
    data: Any


def encode_form(fields: Mapping[str, Any], files: Sequence[tuple[str, bytes]]) -> tuple[str, bytes]:
    """multipart/form-data (RFC 7578): the fields that are not None, then each (file name, content) as `file`.

    Returns the content type and the body.
    """
    boundary = secrets.token_hex(16)
    parts: list[bytes] = []

    def add(disposition: str, content: bytes) -> None:
        head = f"--{boundary}\r\nContent-Disposition: form-data; {disposition}\r\n\r\n"
        parts.append(head.encode() + content + b"\r\n")

    for name, value in fields.items():
        if value is not None:
            text = value if isinstance(value, str) else json.dumps(value)
            add(f'name="{name}"', text.encode("utf-8"))
    for name, content in files:
        quoted = name.replace("\\", "_").replace('"', "%22").replace("\r", "%0D").replace("\n", "%0A")
        add(f'name="file"; filename="{quoted}"', content)
    parts.append(f"--{boundary}--\r\n".encode())
    return f"multipart/form-data; boundary={boundary}", b"".join(parts)


def read_events(stream: BinaryIO) -> Iterator[Event]:
    """The events of a text/event-stream until it ends."""
    identity, name, data = "", "message", []
    for raw in stream:
        line = raw.decode("utf-8").rstrip("\r\n")
        if not line:
            if data:
                yield Event(identity, name, json.loads("\n".join(data)))
            name, data = "message", []
            continue
        field, _, value = line.partition(":")
        value = value[1:] if value.startswith(" ") else value
        if field == "id":
            identity = value
        elif field == "event":
            name = value
        elif field == "data":
            data.append(value)


class Transport:
    """One service's address and token. timeout: seconds that one reply may take."""

    def __init__(self, address: str, token: str | None, timeout: float):
        self.base = address.rstrip("/") + "/api/v1"
        self.token = token
        self.timeout = timeout

    def request(
        self,
        method: str,
        path: str,
        *,
        query: Mapping[str, Any] | None = None,
        headers: Mapping[str, str | None] | None = None,
        document: Any = None,
        form: tuple[str, bytes] | None = None,
        accept: str = "application/json",
    ) -> Reply:
        """Sends a document (as JSON) or a form; raises Problem for any status of 400 and more."""
        with self.open(method, path, query, headers, document, form, accept) as reply:
            return Reply(reply.status, reply.headers, reply.read())

    def events(self, path: str, last: str | None) -> Iterator[Event]:
        """The events of a stream, from the one after `last` on."""
        with self.open("GET", path, None, {"Last-Event-ID": last}, None, None, "text/event-stream") as stream:
            yield from read_events(stream)

    def open(
        self,
        method: str,
        path: str,
        query: Mapping[str, Any] | None,
        headers: Mapping[str, str | None] | None,
        document: Any,
        form: tuple[str, bytes] | None,
        accept: str,
    ) -> Any:
        """The reply as a stream, to be closed by the caller; raises Problem."""
        known = {name: value for name, value in (query or {}).items() if value is not None}
        address = self.base + path + ("?" + urllib.parse.urlencode(known) if known else "")
        head: dict[str, str] = {"Accept": accept}
        head.update({name: value for name, value in (headers or {}).items() if value is not None})
        body = None
        if form is not None:
            head["Content-Type"], body = form
        elif document is not None:
            head["Content-Type"], body = "application/json", json.dumps(document, allow_nan=False).encode("utf-8")
        if self.token is not None:
            head["Authorization"] = f"Bearer {self.token}"
        request = urllib.request.Request(address, data=body, headers=head, method=method)
        try:
            return urllib.request.urlopen(request, timeout=self.timeout)
        except urllib.error.HTTPError as refusal:
            with refusal:
                text = refusal.read()
            try:
                problem = json.loads(text)
            except ValueError:
                problem = {"title": refusal.reason, "detail": text.decode("utf-8", "replace")[:500]}
            raise Problem(refusal.code, problem) from None
