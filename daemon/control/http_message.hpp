#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace roundel {

// That a browser keeps the token in.
inline constexpr const char* kTokenCookie = "roundel_token";

struct HttpRequest {
  std::string method;  // GET, POST, ...
  std::string path;    // without the query
  std::string body;
  bool plain_picture = false;                       // the query has overlay=0
  std::string token;                                // of the query
  std::string host, origin, authorization, cookie;  // headers; the cookie is kTokenCookie's
};

struct HttpResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::string allow;          // of status 405: the methods that there are
  bool event_stream = false;  // instead of a body: server-sent events, until the client leaves
  std::vector<std::pair<std::string, std::string>> headers{};  // more of them
};

// Answers a request. Called on the server's thread; must not throw.
using HttpHandler = std::function<HttpResponse(const HttpRequest&)>;

// The newest server-sent event and its number; nullptr: none yet.
struct HttpEvent {
  std::uint64_t number = 0;
  std::shared_ptr<const std::string> text;
};
using HttpEvents = std::function<HttpEvent()>;

}  // namespace roundel
