#include "daemon/control/web_gate.hpp"

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>

#include "daemon/control/http_server.hpp"
#include "daemon/control/web_page.hpp"
#include "daemon/control/web_socket.hpp"
#include "tests/error_of.hpp"

using namespace roundel;

namespace {

const std::string kToken = "correct-horse-battery";

HttpRequest request(const std::string& method, const std::string& path, const std::string& host) {
  HttpRequest result;
  result.method = method;
  result.path = path;
  result.host = host;
  return result;
}

WebGate gate(const std::string& token) {
  return {[](const HttpRequest&) { return HttpResponse(); }, token};
}

std::string header(const HttpResponse& response, const std::string& name) {
  const auto found = std::find_if(response.headers.begin(), response.headers.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  return found == response.headers.end() ? "" : found->second;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("without a token, only names of this machine are answered") {
  const WebGate open = gate("");
  for (const char* host :
       {"localhost", "localhost:8080", "127.0.0.1:8080", "127.1.2.3", "[::1]", "[::1]:8080"}) {
    CAPTURE(host);
    CHECK(open.handle(request("GET", "/v1/status", host)).status == 200);
  }
  for (const char* host :
       {"", "evil.example", "evil.example:8080", "127.0.0.1.evil.example", "127.evil.example",
        "localhost.evil.example", "[::2]:8080", "192.168.0.2"}) {
    CAPTURE(host);
    CHECK(open.handle(request("GET", "/v1/status", host)).status == 403);
  }
}

TEST_CASE("with a token, only who has it gets in, from wherever") {
  const WebGate closed = gate(kToken);
  HttpRequest asked = request("GET", "/v1/status", "arena.example:8080");
  CHECK(closed.handle(asked).status == 401);
  for (const std::string& wrong : {std::string(""), std::string("x"), kToken + "x", kToken + kToken,
                                   kToken.substr(1), std::string(kToken.size(), '\0')}) {
    CAPTURE(wrong);
    asked.authorization = "Bearer " + wrong;
    CHECK(closed.handle(asked).status == 401);
  }
  asked.authorization = "Bearer " + kToken;
  CHECK(closed.handle(asked).status == 200);
  asked.authorization = "Basic " + kToken;
  CHECK(closed.handle(asked).status == 401);
  asked.authorization.clear();
  asked.cookie = kToken;
  CHECK(closed.handle(asked).status == 200);
}

TEST_CASE("a token in the address becomes a cookie, and a page asks who has none") {
  const WebGate closed = gate(kToken);
  HttpRequest asked = request("GET", "/", "arena.example");
  const HttpResponse refused = closed.handle(asked);
  CHECK(refused.status == 401);
  CHECK(has(refused.body, "<form"));
  CHECK(header(refused, "WWW-Authenticate") == "Bearer");
  asked.token = kToken;
  const HttpResponse moved = closed.handle(asked);
  CHECK(moved.status == 303);
  CHECK(header(moved, "Location") == "/");
  CHECK(header(moved, "Set-Cookie") ==
        "roundel_token=" + kToken + "; Path=/; HttpOnly; SameSite=Strict");
  asked.path = "/v1/status";
  CHECK(closed.handle(asked).status == 200);
}

TEST_CASE("another site's page changes nothing") {
  for (const std::string& token : {std::string(), kToken}) {
    CAPTURE(token);
    HttpRequest asked = request("POST", "/v1/reload", "localhost:8080");
    asked.cookie = token;
    CHECK(gate(token).handle(asked).status == 200);  // a program
    asked.origin = "http://localhost:8080";
    CHECK(gate(token).handle(asked).status == 200);  // its own page
    for (const char* origin :
         {"http://evil.example", "null", "http://localhost:9090", "https://localhost:8080"}) {
      CAPTURE(origin);
      asked.origin = origin;
      CHECK(gate(token).handle(asked).status == 403);
    }
  }
}

TEST_CASE("the page asks for nothing from elsewhere, and runs only its own script") {
  const HttpResponse first = web_page(), second = web_page();
  CHECK(first.type == "text/html; charset=utf-8");
  const std::string policy = header(first, "Content-Security-Policy");
  CHECK(has(policy, "default-src 'none'"));
  CHECK_FALSE(has(policy, "unsafe"));
  CHECK(policy != header(second, "Content-Security-Policy"));
  CHECK_FALSE(has(first.body, "NONCE"));
  const std::size_t at = policy.find("'nonce-") + 7;
  const std::string nonce = policy.substr(at, 32);
  CHECK(has(first.body, "<script nonce=\"" + nonce + "\""));
  CHECK_FALSE(has(first.body, "src=\"http"));
  CHECK_FALSE(has(first.body, "href=\"http"));
  CHECK(first.body.size() < 20000);
  CHECK(header(gate("").handle(request("GET", "/", "localhost")), "X-Content-Type-Options") ==
        "nosniff");
}

TEST_CASE("addresses for the web are numbers and a port") {
  CHECK(parse_web_address("127.0.0.1:8080")->loopback);
  CHECK(parse_web_address("[::1]:1")->loopback);
  CHECK_FALSE(parse_web_address("0.0.0.0:8080")->loopback);
  CHECK_FALSE(parse_web_address("[::]:8080")->loopback);
  CHECK(parse_web_address("10.0.0.1:65535")->port == 65535);
  for (const char* text : {"", ":80", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "::1:80",
                           "[::1:80", "[]:80", "host:80", "127.0.0.1:8 0", "127.0.0.1:-1"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_web_address(text).has_value());
  }
}

TEST_CASE("a port that is taken is told") {
  const WebSocket first = listen_for_web(*parse_web_address("127.0.0.1:0"));
  CHECK(first.url.starts_with("http://127.0.0.1:"));
  const std::string port = first.url.substr(17, first.url.size() - 18);
  CHECK(has(error_of([&] { listen_for_web(*parse_web_address("127.0.0.1:" + port)); }),
            "Address already in use"));
}

TEST_CASE("what a browser sends over TCP reaches the gate, and its answer the browser") {
  WebSocket socket = listen_for_web(*parse_web_address("127.0.0.1:0"));
  const int port = std::stoi(socket.url.substr(17));
  const WebGate closed = gate(kToken);
  const HttpServer server(std::move(socket.descriptor),
                          [&](const HttpRequest& request) { return closed.handle(request); }, {});
  const auto ask = [port](const std::string& line, const std::string& headers) {
    const UniqueFd client(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) ==
            0);
    const std::string text = line + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" +
                             headers + "Content-Length: 0\r\n\r\n";
    REQUIRE(::send(client.get(), text.data(), text.size(), MSG_NOSIGNAL) ==
            static_cast<ssize_t>(text.size()));
    std::string answer;
    std::array<char, 4096> buffer{};
    for (ssize_t n = 0; (n = ::recv(client.get(), buffer.data(), buffer.size(), 0)) > 0;) {
      answer.append(buffer.data(), static_cast<std::size_t>(n));
    }
    return answer;
  };
  CHECK(has(ask("GET /v1/status", ""), "401 Unauthorized"));
  CHECK(has(ask("GET /v1/status", "Authorization: Bearer " + kToken + "\r\n"), "200 OK"));
  CHECK(has(ask("GET /v1/status", "Cookie: a=b; roundel_token=" + kToken + "\r\n"), "200 OK"));
  CHECK(has(ask("GET /?token=" + kToken, ""), "Set-Cookie: roundel_token=" + kToken));
  CHECK(has(ask("POST /v1/reload",
                "Origin: http://evil.example\r\nCookie: roundel_token=" + kToken + "\r\n"),
            "403 Forbidden"));
}
