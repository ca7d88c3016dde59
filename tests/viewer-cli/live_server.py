"""The server of glint live, attacked: live_server.py HTTP_HOST. After each attack it answers, holds no more memory, and has no connection left over.
Speaks TAP."""
import itertools
import json
import os
import random
import resource
import select
import socket
import struct
import sys
import time

import tap
from http_client import HOST, Server, read_answer

LIMIT = 1 << 20  # bytes of a body
with open(HOST, "rb") as program:
    CODE = program.read()
MEMORY_MB = 400 if b"__tsan_init" in CODE else 150 if b"__asan_init" in CODE else 40  # more than at first; sanitizers keep what is freed, and shadows
GUARDS = {"x-content-type-options": "nosniff", "referrer-policy": "no-referrer", "cache-control": "no-store", "x-frame-options": "DENY",
          "cross-origin-opener-policy": "same-origin", "cross-origin-resource-policy": "same-origin"}


def random_hex(digits):
    return "".join(random.choice("0123456789abcdef") for _ in range(digits))


def refused(answer, status, code):
    assert answer and answer.status == status and answer.json()["code"] == code, (answer, status, code)
    assert "access-control-allow-origin" not in answer.headers, answer
    for name, value in GUARDS.items():
        assert answer.headers[name] == value, answer


class Tests:
    def __init__(self):
        resource.setrlimit(resource.RLIMIT_NOFILE, (min(4096, resource.getrlimit(resource.RLIMIT_NOFILE)[1]),) * 2)
        self.server = Server()
        for _ in range(20):
            self.server.ask("/api/v1/echo")
        time.sleep(0.1)
        self.first_mb, self.first_state = self.server.status("VmRSS") / 1024, self.server.state()

    def check(self):
        """The server answers at once, and has nothing left over."""
        start = time.monotonic()
        answer = self.server.ask("/api/v1/echo", "POST", body={"still": "here"})
        assert answer.status == 200 and answer.json()["body"] == {"still": "here"}, answer
        assert time.monotonic() - start < 1, time.monotonic() - start
        for _ in range(60):
            if self.server.state() == self.first_state:
                break
            time.sleep(0.05)
        assert self.server.state() == self.first_state, (self.server.state(), self.first_state)
        grown = self.server.status("VmRSS") / 1024 - self.first_mb, self.server.status("VmHWM") / 1024 - self.first_mb
        assert max(grown) < MEMORY_MB, grown
        return grown

    def calls(self):
        return self.server.ask("/api/v1/counts").json()["calls"]

    # ---- Who may ask ----

    def test_the_page_needs_no_token_and_forbids_to_be_used(self):
        answer = self.server.ask("/", token=None)
        assert answer.status == 200 and b"<title>host" in answer.body and answer.headers["content-type"].startswith("text/html"), answer
        for name, value in GUARDS.items():
            assert answer.headers[name] == value, answer
        head = self.server.ask("/", "HEAD", token=None)
        assert head.status == 200 and head.headers["content-length"] == str(len(answer.body)), head
        refused(self.server.ask("/", token=None, body={"a": 1}), 400, "format")
        self.check()

    def test_another_host_is_refused(self):
        port, calls = self.server.port, self.calls()
        for path in ("/", "/api/v1/echo"):
            for host in (f"127.0.0.1:{port}", f"localhost:{port}", f"[::1]:{port}"):
                assert self.server.ask(path, Host=host).status == 200, host
            for host in ("127.0.0.1", "localhost", "", f"evil.example:{port}", f"127.0.0.1.evil.example:{port}", f"127.0.0.1:{port}@evil.example",
                         f"evil.example@127.0.0.1:{port}", f"localhost.:{port}", f"127.1:{port}", f"2130706433:{port}", f"0.0.0.0:{port}",
                         f"127.0.0.1:{port}.evil.example", f"127.0.0.1:0{port}", "127.0.0.1:80", f"127.0.0.1:{port}, evil.example", f":{port}",
                         f"127.0.0.2:{port}", "x" * 8000 + f":{port}"):
                refused(self.server.ask(path, Host=host), 403, "origin")
            refused(self.server.ask(path, Host=None, version="HTTP/1.0"), 403, "origin")
            assert self.server.ask(path, Host=None).status == 400
        refused(self.server.ask("/api/v1/echo", Host=f"{self.server.name}\r\nHost: evil.example"), 400, "format")
        assert self.calls() == calls + 3
        self.check()

    def test_another_origin_is_refused(self):
        port, calls = self.server.port, self.calls()
        for path in ("/", "/api/v1/echo"):
            for origin in (f"http://127.0.0.1:{port}", f"http://localhost:{port}"):
                assert self.server.ask(path, Origin=origin).status == 200, origin
            for origin in ("null", "", "http://evil.example", f"https://127.0.0.1:{port}", f"http://127.0.0.1:{port}/", "http://127.0.0.1",
                           f"http://127.0.0.1:{port + 1 if port < 65535 else 1}", f"http://evil.example:{port}", f"127.0.0.1:{port}",
                           f"HTTP://evil.example:{port}", f"http://http://127.0.0.1:{port}"):
                refused(self.server.ask(path, Origin=origin), 403, "origin")
            refused(self.server.ask(path, Sec_Fetch_Site="cross-site"), 403, "origin")
            assert self.server.ask(path, Sec_Fetch_Site="same-origin").status == 200
        refused(self.server.ask("/api/v1/echo", "OPTIONS", token=None, Origin="http://evil.example", Access_Control_Request_Method="POST",
                                Access_Control_Request_Headers="authorization"), 403, "origin")
        assert self.calls() == calls + 3
        self.check()

    def test_a_guessed_token_is_refused(self):
        token, calls = self.server.token, self.calls()
        other = "0" if token[-1] != "0" else "1"
        assert len(token) == 64 and set(token) <= set("0123456789abcdef")
        for value in (None, "", token, "Bearer", "Bearer ", f"Basic {token}", f"Bearer {token[:-1]}", f"Bearer {token}0", f"Bearer {token[:-1]}{other}",
                      f"Bearer {other}{token[1:]}" if token[0] != other else "Bearer x", f"Bearer  {token}", f"Bearer {token.upper()}x",
                      f"Bearer {token},{token}", "Bearer " + "0" * 64, "Bearer " + "x" * 9000):
            answer = self.server.ask("/api/v1/echo", token=value)
            refused(answer, 401, "token")
            assert answer.headers["www-authenticate"] == "Bearer" and answer.headers["connection"] == "close", answer
            refused(self.server.ask("/api/v1/none", token=value), 401, "token")  # what there is shows no one without it
            refused(self.server.ask(f"/api/v1/echo?token={token}", "POST", token=value, body={"token": token}), 401, "token")
        for _ in range(200):
            refused(self.server.ask("/api/v1/echo", token="Bearer " + random_hex(64)), 401, "token")
        refused(self.server.ask("/api/v1/echo", Authorization=f"Bearer {token}\r\nAuthorization: Bearer {token}"), 400, "format")
        assert self.calls() == calls
        assert self.server.ask("/api/v1/echo", token=f"bearer {token}").status == 200
        self.check()

    def test_nothing_but_the_page_and_the_routes_can_be_read(self):
        calls = self.calls()
        for path in ("/index.html", "/favicon.ico", "//", "/.", "/..", "/api", "/api/", "/api/v1", "/api/v1/", "/api/v1/echo/", "//api/v1/echo", "/api//v1/echo",
                     "/api/v1/../v1/echo", "/api/v1/..", "/../../../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/..%2f..%2fetc/passwd", "/etc/passwd",
                     "/api/v1/%65cho", "/api/v1/echo%00", "/%00", "/api/v1/echo%00.png", "/API/v1/echo", "/api/v1/echo;x", "/api/v1/echo#x", "/api\\v1\\echo",
                     f"http://{self.server.name}/", f"http://{self.server.name}/api/v1/echo", "http://evil.example/", "file:///etc/passwd", "*", "echo", "",
                     "/" + "a" * 9000, "/" + "../" * 3000):
            answer = self.server.ask(path)
            assert answer and answer.status in (400, 404), (path, answer)
            assert b"root:" not in answer.body and self.server.ask(path, token=None).status in (400, 401, 404)
        for data in (b"GET /\0/../../etc/passwd HTTP/1.1", b"GET /api/v1/echo\0 HTTP/1.1", b"GET  /api/v1/echo HTTP/1.1", b"GET\t/api/v1/echo\tHTTP/1.1", b"\0\0\0\0",
                     b"GET / /etc/passwd HTTP/1.1"):
            answer = self.server.send(data + f"\r\nHost: {self.server.name}\r\n\r\n".encode())
            assert answer is None or answer.status != 200 or answer.body.startswith(b"<!doctype html><title>host"), (data, answer)
        assert self.calls() == calls
        self.check()

    def test_a_value_of_the_query_is_text(self):
        assert self.server.ask("/api/v1/echo?text=a%20b+c%C3%A9%26&x").json()["text"] == "a b cé&"
        for query in ("text=%00", "text=a%00b", "a%00b=1", "text=%ff", "text=%C3", "%ff=1", "text=%ED%A0%80"):
            refused(self.server.ask("/api/v1/echo?" + query), 400, "format")
        self.check()

    def test_other_methods_are_refused(self):
        calls = self.calls()
        for method in ("HEAD", "OPTIONS", "TRACE", "PUT", "DELETE", "PATCH", "CONNECT", "get", "GETT", "X" * 300):
            answer = self.server.ask("/api/v1/echo", method)
            assert answer.status == 405 and answer.headers["allow"] == "GET, POST", (method, answer)
            assert not any(name.startswith("access-control") for name in answer.headers), answer
            if method != "HEAD":
                answer = self.server.ask("/", method, token=None)
                refused(answer, 405, "unknown")
                assert answer.headers["allow"] == "GET, HEAD" and self.server.token.encode() not in answer.body, answer
        answer = self.server.ask("/api/v1/block", "POST", body={"a": 1})
        refused(answer, 405, "unknown")
        assert answer.headers["allow"] == "GET" and self.calls() == calls
        self.check()

    # ---- Bodies ----

    def endless(self, start, part, most=1 << 30):
        """Sends a start, and parts until the server has closed; how many bytes, and the answer."""
        sent = 0
        with self.server.connect() as connection:
            try:
                connection.sendall(start)
                while sent < most:
                    connection.sendall(part)
                    sent += len(part)
            except ConnectionError:
                pass
            assert sent < 16 << 20, sent
            try:
                return sent, read_answer(connection.makefile("rb"))
            except ConnectionError:
                return sent, None

    def test_bodies_of_a_gigabyte_are_refused(self):
        for size in (1 << 30, 1 << 40, LIMIT + 1):
            refused(self.server.ask("/api/v1/echo", "POST", Content_Length=size), 413, "size")
            refused(self.server.ask("/api/v1/echo", "POST", Content_Length=size, Expect="100-continue"), 413, "size")
            refused(self.server.ask("/api/v1/echo", "POST", token=None, Content_Length=size), 401, "token")
            refused(self.server.ask("/", token=None, Content_Length=size), 400, "format")
        for size in ("-1", "1e9", "0x10", str(1 << 64), str(1 << 70), "", "1, 1"):
            answer = self.server.ask("/api/v1/echo", "POST", Content_Length=size)
            assert answer is None or answer.status in (400, 413), (size, answer)
        for token in (True, None):
            sent, answer = self.endless(self.server.request("/api/v1/echo", "POST", token=token, Content_Length=1 << 30), b"x" * 65536)
            assert answer is None or answer.status == (413 if token else 401), (sent, answer)
        self.check()

    def test_a_body_of_a_mebibyte_is_taken(self):
        for extra, status in ((0, 200), (1, 413)):
            body = b'{"a": "' + b"x" * (LIMIT - 9 + extra) + b'"}'
            assert len(body) == LIMIT + extra
            assert self.server.ask("/api/v1/echo", "POST", body=body).status == status
            chunks = b"".join(b"%x\r\n%b\r\n" % (len(body[i:i + 50000]), body[i:i + 50000]) for i in range(0, len(body), 50000)) + b"0\r\n\r\n"
            answer = self.server.ask("/api/v1/echo", "POST", body=chunks, length=False, Transfer_Encoding="chunked")
            assert answer.status == status, answer
        self.check()

    def test_chunks_without_end_are_refused(self):
        start = self.server.request("/api/v1/echo", "POST", Transfer_Encoding="chunked")
        for part in (b"10000\r\n" + b"x" * 65536 + b"\r\n", b"1\r\nx\r\n" * 4096, b"1;" + b"y" * 60000, b"0" * 65536, b"ffffffffffffffff\r\n" + b"x" * 65536):
            sent, answer = self.endless(start, part)
            assert answer is None or answer.status in (400, 413, 500), (sent, answer)  # 500: libmicrohttpd's of a chunk's line without end
        sent, answer = self.endless(self.server.request("/api/v1/echo", "POST", token=None, Transfer_Encoding="chunked"), b"10000\r\n" + b"x" * 65536 + b"\r\n")
        assert answer is None or answer.status == 401, answer
        for encoding in ("gzip", "identity", "chunked, chunked", "xchunked"):
            answer = self.server.ask("/api/v1/echo", "POST", body=b"0\r\n\r\n", length=False, Transfer_Encoding=encoding)
            assert answer is None or answer.status == 400, (encoding, answer)
        refused(self.server.ask("/api/v1/echo", "POST", body=b"0\r\n\r\n", Transfer_Encoding="chunked"), 400, "format")
        refused(self.server.ask("/api/v1/echo", "POST", body=b"{}", Content_Length="2\r\nContent-Length: 2"), 400, "format")
        self.check()

    def test_headers_without_end_are_refused(self):
        for start, part in ((b"GET / HTTP/1.1\r\n", b"X-Y: " + b"z" * 1000 + b"\r\n"), (b"GET / HTTP/1.1\r\nX: ", b"z" * 4096), (b"GET /", b"z" * 4096), (b"", b"G" * 4096),
                            (b"GET /?", b"a=b&" * 1000), (b"GET / HTTP/1.1\r\nX: y\r\n", b" z\r\n" * 1000), (b"GET / HTTP/1.1\r\n", b"A:b\r\n" * 1000)):
            sent, answer = self.endless(start, part)
            assert answer is None or answer.status in (400, 413, 414, 431), (start, sent, answer)
        self.check()

    def test_a_body_that_is_no_object_is_refused(self):
        deep = b'{"a": ' * 100000 + b"1" + b"}" * 100000
        for body in (b"{", b"[]", b"1", b'"a"', b"null", b"x", b"\0", b"{}x", b"{} {}", b"{'a': 1}", b'{"a": 1,}', b'{"a": 1, "a": 2}', b'{"a": {"b": 1, "b": 1}}', b" ",
                     b'{"a": NaN}', b'{"a": 1e999}', b'{"a": 99999999999999999999}', b'{"a": "\\u0000"}', b'{"a\\u0000b": 1}', b'{"a": "\0"}', b'{"a": "\xff"}',
                     b'{"a": "\xed\xa0\x80"}', b'{"a": "\\ud800"}', b'{"a": "\n"}', b"[" * 500000, deep, b'{"a":' + b"[" * 100000, b"\xef\xbb\xbf{}", b"\xff\xfe{\0}\0"):
            answer = self.server.ask("/api/v1/echo", "POST", body=body)
            refused(answer, 400, "format")
            assert "has to be a JSON object" in answer.json()["error"], answer
        answer = self.server.ask("/api/v1/echo", "POST", body=b'{\n  "a": 1,\n  "b": x\n}')
        assert "line 3" in answer.json()["error"], answer
        body = {"text": "é \u2028 </script> \"", "list": [1, 2.5, None, True, {}], "": {"a": []}}
        assert self.server.ask("/api/v1/echo", "POST", body=body).json()["body"] == body
        nested = b'{"a":' + b"[" * 2040 + b"]" * 2040 + b"}"
        assert self.server.ask("/api/v1/echo", "POST", body=nested).body.replace(b" ", b"").endswith(nested + b"}")
        assert self.server.ask("/api/v1/echo", "POST").json()["body"] is None
        self.check()

    # ---- Many, and slow ones ----

    def test_a_thousand_requests_at_once(self):
        answers = self.server.at_once(1000, self.server.request("/api/v1/block?ms=50", Connection="close"))
        statuses = [int(a.split()[1]) if a else 0 for a in answers]
        assert set(statuses) <= {200, 503}, {s: statuses.count(s) for s in statuses}
        assert statuses.count(200) >= 112, statuses.count(200)
        for answer, status in zip(answers, statuses):
            body = json.loads(answer.split(b"\r\n\r\n", 1)[1])
            assert body == {"ended": False} if status == 200 else body["code"] == "busy", answer
        grown = self.check()
        print(f"# a thousand at once: {statuses.count(200)} answered, {statuses.count(503)} refused, memory grown by {grown[0]:.0f} MB, {grown[1]:.0f} at most")
        statuses = [int(a.split()[1]) if a else 0 for a in self.server.at_once(1000, self.server.request("/api/v1/echo", Connection="close"))]
        assert statuses == [200] * 1000, {s: statuses.count(s) for s in statuses}
        statuses = [int(a.split()[1]) if a else 0 for a in self.server.at_once(1000, self.server.request("/api/v1/echo", token=None))]
        assert statuses == [401] * 1000, {s: statuses.count(s) for s in statuses}
        self.check()

    def test_as_many_as_there_are_places_leave_room_for_a_refusal(self):
        server = Server()
        streams = [server.connect() for _ in range(112)]
        for stream in streams:
            stream.sendall(server.request("/api/v1/events"))
            assert stream.recv(1)
        start = time.monotonic()
        refused(server.ask("/api/v1/echo"), 503, "busy")
        refused(server.ask("/api/v1/echo", token=None), 401, "token")
        assert server.ask("/", token=None).status == 200 and time.monotonic() - start < 1
        for stream in streams:
            stream.close()
        for _ in range(60):
            if (status := server.ask("/api/v1/echo").status) == 200:
                break
            time.sleep(0.05)
        assert status == 200, status
        _, status, said = server.end()
        assert status == 0 and not said, (status, said)

    def test_those_without_the_token_cannot_keep_others_out(self):
        # a header a byte at a time; more connections than the server has places
        known = self.server.connect()
        known.sendall(self.server.request("/api/v1/echo"))
        assert read_answer(known.makefile("rb")).status == 200
        connections = [self.server.connect() for _ in range(200)]
        try:
            for connection in connections:
                connection.sendall(b"GET / HTTP/1.1\r\nHost: ")
            start = time.monotonic()
            asked = self.server.connect()
            asked.sendall(self.server.request("/api/v1/echo"))
            while not select.select([asked], [], [], 0.1)[0] and time.monotonic() - start < 8:
                for connection in connections:
                    try:
                        connection.send(b"x")
                    except ConnectionError:
                        pass
            seconds = time.monotonic() - start
            answer = read_answer(asked.makefile("rb"))
            assert answer and answer.status == 200 and seconds < 5, (answer, seconds)
            # one that has shown the token stays
            known.sendall(self.server.request("/api/v1/echo"))
            assert read_answer(known.makefile("rb")).status == 200
            known.close()
            asked.close()
            print(f"# answered after {seconds:.1f} s")
        finally:
            for connection in connections:
                connection.close()
        self.check()

    def test_those_that_read_slowly_hinder_no_one(self):
        size, server = 4 << 20, Server()
        assert server.ask("/api/v1/echo").status == 200
        first_mb = server.status("VmRSS") / 1024
        connections = [server.connect() for _ in range(24)]
        for connection in connections:
            connection.sendall(server.request(f"/api/v1/large?bytes={size}"))
        time.sleep(0.3)
        for _ in range(50):
            start = time.monotonic()
            assert server.ask("/api/v1/echo").status == 200 and time.monotonic() - start < 1
        body = read_answer(connections[0].makefile("rb")).body
        assert body == b"x" * size
        for connection in connections:
            connection.close()
        # an answer is held once for each of them, and not longer
        assert server.status("VmHWM") / 1024 - first_mb < MEMORY_MB + 24 * size / 1e6
        for _ in range(60):
            if server.status("VmRSS") / 1024 - first_mb < MEMORY_MB:
                break
            time.sleep(0.05)
        assert server.status("VmRSS") / 1024 - first_mb < MEMORY_MB, (first_mb, server.status("VmRSS") / 1024)
        _, status, said = server.end()
        assert status == 0 and not said, (status, said)

    def test_those_that_send_slowly_are_answered(self):
        data = self.server.request("/api/v1/echo", "POST", body={"slow": True})
        with self.server.connect() as connection:
            for i in range(len(data)):
                connection.sendall(data[i:i + 1])
                time.sleep(0.002)
            assert read_answer(connection.makefile("rb")).json()["body"] == {"slow": True}
        self.check()

    def test_requests_in_one_packet_are_answered_in_order(self):
        data = b"".join(self.server.request(f"/api/v1/echo?text={i}", "POST", body={"n": i}) for i in range(50))
        with self.server.connect() as connection, connection.makefile("rb") as file:
            connection.sendall(data)
            for i in range(50):
                answer = read_answer(file).json()
                assert answer["text"] == str(i) and answer["body"] == {"n": i}, answer
            # the token of one request is not that of the next
            connection.sendall(self.server.request("/api/v1/echo") + self.server.request("/api/v1/echo", token=None) + self.server.request("/api/v1/echo"))
            assert [a and a.status for a in (read_answer(file), read_answer(file), read_answer(file))] == [200, 401, None]
        self.check()

    def test_those_that_close_early_leave_nothing(self):
        with self.server.connect() as connection:
            connection.sendall(self.server.request("/api/v1/block?ms=100"))
            connection.shutdown(socket.SHUT_WR)
            assert read_answer(connection.makefile("rb")).status == 200
        whole = self.server.request("/api/v1/large?bytes=3000000", body={"a": "x" * 100})
        for cut, hard in itertools.product(range(0, len(whole) + 1, 16), (False, True)):
            connection = self.server.connect()
            connection.sendall(whole[:cut])
            if hard:
                connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            connection.close()
        self.check()

    def test_damaged_requests_are_answered_or_closed(self):
        rng, calls = random.Random(24), self.calls()
        whole = self.server.request("/api/v1/echo?text=a", "POST", token=None, body={"a": 1})
        for _ in range(400):
            data = bytearray(whole)
            for _ in range(rng.randrange(1, 5)):
                at = rng.randrange(len(data))
                data[at:at + rng.choice((0, 1, 1, 8))] = rng.choice((b"", b"\0", b"\r\n", b" ", b":", b"\xff", bytes([rng.randrange(256)]), b"z" * 300))
            with self.server.connect() as connection:
                connection.sendall(data)
                connection.shutdown(socket.SHUT_WR)
                try:
                    answer = read_answer(connection.makefile("rb"))
                except ConnectionError:
                    continue
                assert answer is None or answer.status in (400, 401, 403, 404, 405, 413, 501, 505) or answer.body.startswith(b"<!doctype"), (data, answer)
        assert self.calls() == calls
        self.check()

    # ---- Answers ----

    def test_a_stream_ends_when_its_client_goes(self):
        connections = [self.server.connect() for _ in range(5)]
        for connection in connections:
            connection.sendall(self.server.request("/api/v1/events"))
            file = connection.makefile("rb")
            while not (line := file.readline()).startswith(b'{"tick": 3}'):
                assert line, "the stream ended"
        assert self.server.ask("/api/v1/counts").json()["streams"] == 5
        for connection in connections:
            connection.close()
            file.close()
        for _ in range(40):
            streams = self.server.ask("/api/v1/counts").json()["streams"]
            if not streams:
                break
            time.sleep(0.05)
        assert streams == 0, streams
        self.check()

    def test_a_download_has_a_safe_name(self):
        for name, value in (("run.exr", "\"run.exr\"; filename*=UTF-8''run.exr"), ("../a%22%0D%0AX:%20y\\é", "\".._a___X__y___\"; filename*=UTF-8''..%2Fa%22%0D%0AX%3A%20y%5C%C3%A9")):
            answer = self.server.ask("/api/v1/large?bytes=9&name=" + name.encode().decode("latin-1"))
            assert answer.headers["content-disposition"] == "attachment; filename=" + value and "x" not in answer.headers, answer
        self.check()

    def test_errors_have_their_status(self):
        wanted = {1: (400, "usage"), 2: (500, "io"), 3: (500, "format"), 4: (500, "format"), 5: (500, "device"), 6: (500, "memory"), 7: (500, "device"), 8: (409, "superseded"),
                  0: (500, "device"), 99: (500, "device")}
        for code, (status, name) in wanted.items():
            answer = self.server.ask(f"/api/v1/fail?code={code}&text=%3Cb%3E")
            refused(answer, status, name)
            assert answer.json()["error"] == 'message \\xff of "<b>"', answer
        self.check()

    # ---- Start and stop ----

    def test_it_listens_where_it_is_told(self):
        taken = Server("127.0.0.1", str(self.server.port))
        _, status, said = taken.end()
        assert status == 1 and f"port {self.server.port} of 127.0.0.1 is in use" in said, (status, said)
        for address, wanted in (("203.0.113.7", "no address of this machine"), ("evil.example", "no IP address"), ("localhost", "no IP address")):
            _, status, said = Server(address).end()
            assert status == 1 and wanted in said, (status, said)
        for address, at, own, foreign in (("0.0.0.0", "127.0.0.1", ("127.0.0.1", "localhost", "192.0.2.1", "[2001:db8::1]"), ("evil.example", "192.0.2.1.evil.example", "[::1", "::1")),
                                          ("127.0.0.2", "127.0.0.2", ("127.0.0.2", "localhost"), ("127.0.0.3", "evil.example")),
                                          ("::1", "::1", ("[::1]", "localhost", "127.0.0.1"), ("::1", "[::2]", "evil.example")),
                                          ("::", "::1", ("[::1]", "192.0.2.1"), ("evil.example", "[x]"))):
            server = Server(address)
            for host in own:
                assert server.send(server.request("/", Host=f"{host}:{server.port}"), address=at).status == 200, (address, host)
            for host in foreign:
                refused(server.send(server.request("/", Host=f"{host}:{server.port}"), address=at), 403, "origin")
            _, status, said = server.end()
            assert status == 0 and not said, (status, said)

    def test_it_stops_while_clients_hang(self):
        server = Server()
        hanging = [server.connect() for _ in range(60)]
        starts = (b"", b"GET /", server.request("/api/v1/block?ms=60000"), server.request("/api/v1/events"), server.request("/api/v1/large?bytes=8000000"),
                  server.request("/api/v1/echo", "POST", Content_Length=1000) + b'{"a": ')
        for connection, data in zip(hanging, itertools.cycle(starts)):
            connection.sendall(data)
        time.sleep(0.3)
        seconds, status, said = server.end()
        assert status == 0 and not said and seconds < 6, (seconds, status, said)
        # answers that wait are still sent
        answer = read_answer(hanging[2].makefile("rb"))
        assert answer and answer.json() == {"ended": True}, answer
        for connection in hanging:
            connection.close()
        print(f"# stopped in {seconds:.1f} s")

    def test_it_stops_without_waiting_when_no_one_hangs(self):
        server = Server()
        assert server.ask("/api/v1/echo").status == 200
        idle = server.connect()
        seconds, status, said = server.end()
        assert status == 0 and not said and seconds < 1, (seconds, status, said)
        idle.close()

    def test_zz_the_server_ends_without_a_word(self):
        _, status, said = self.server.end()
        assert status == 0 and not said, (status, said)


tests = Tests()
failed = tap.run(tests)
if tests.server.process.poll() is None:
    tests.server.end()
sys.exit(failed)
