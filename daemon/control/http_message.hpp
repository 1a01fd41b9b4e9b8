#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace roundel {

struct HttpRequest {
  std::string method;  // GET, POST, ...
  std::string path;    // without the query
  std::string body;
  bool plain_picture = false;  // the query has overlay=0
};

struct HttpResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::string allow;          // of status 405: the methods that there are
  bool event_stream = false;  // instead of a body: server-sent events, until the client leaves
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
