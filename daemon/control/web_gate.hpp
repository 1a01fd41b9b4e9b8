#pragma once

#include <string>

#include "daemon/control/http_message.hpp"

namespace roundel {

// Stands before what is served over TCP, where browsers are, and with them every page that their
// owner looks at. With a token, only who has it gets in: `Authorization: Bearer TOKEN`, or a cookie
// that ?token=TOKEN sets. Without, only this machine gets there, and a name that somebody else's
// page has made to mean this machine (DNS rebinding) is refused. In neither case may another site's
// page change anything.
class WebGate {
 public:
  WebGate(HttpHandler inner, std::string token)
      : inner_(std::move(inner)), token_(std::move(token)) {}

  HttpResponse handle(const HttpRequest& request) const;

 private:
  bool has_token(const HttpRequest& request) const;
  HttpResponse let_in(const HttpRequest& request) const;

  HttpHandler inner_;
  std::string token_;  // empty: none
};

// Takes a time that tells nothing about where they differ.
bool equal_secretly(const std::string& given, const std::string& secret);

}  // namespace roundel
