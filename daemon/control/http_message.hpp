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
  bool keep_tracks = false;                         // the query has restart=0
  std::string token;                                // of the query
  std::string host, origin, authorization, cookie;  // headers; the cookie is kTokenCookie's
};

// A body that grows while it is sent. Lives on the server's thread, and ends with the connection.
class HttpStream {
 public:
  HttpStream() = default;
  virtual ~HttpStream() = default;
  HttpStream(const HttpStream&) = delete;
  HttpStream& operator=(const HttpStream&) = delete;

  // Copies what comes next, at most so many bytes. 0: there is nothing more before
  // HttpServer::wake_streams() is called.
  virtual std::size_t read(char* out, std::size_t room) = 0;
};

struct HttpResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::string allow;                   // of status 405: the methods that there are
  std::unique_ptr<HttpStream> stream;  // instead of a body, until the client leaves
  std::vector<std::pair<std::string, std::string>> headers{};  // more of them
};

// Answers a request. Called on the server's thread; must not throw.
using HttpHandler = std::function<HttpResponse(const HttpRequest&)>;

}  // namespace roundel
