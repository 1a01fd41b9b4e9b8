#include "daemon/control/web_gate.hpp"

#include <cstddef>

#include "daemon/control/web_page.hpp"

namespace roundel {
namespace {

constexpr int kSeeOther = 303, kUnauthorized = 401, kForbidden = 403;

HttpResponse refusal(int status, const char* what) {
  return {status, "application/json", std::string(R"({"error":")") + what + "\"}\n", "", nullptr};
}

// "localhost:8080", "127.0.0.1", "[::1]:8080"
bool is_this_machine(const std::string& host) {
  const std::size_t colon = host.rfind(':');
  const bool has_port = colon != std::string::npos && host.find(']', colon) == std::string::npos;
  const std::string name = has_port ? host.substr(0, colon) : host;
  if (name == "localhost" || name == "[::1]") return true;
  return name.starts_with("127.") && name.find_first_not_of("0123456789.") == std::string::npos;
}

}  // namespace

bool equal_secretly(const std::string& given, const std::string& secret) {
  // volatile: the compiler must not stop at the first difference either.
  volatile std::size_t difference = given.size() ^ secret.size();
  for (std::size_t i = 0; i < given.size(); ++i) {
    const auto other = static_cast<unsigned char>(secret.empty() ? 0 : secret[i % secret.size()]);
    difference = difference | (static_cast<unsigned char>(given[i]) ^ other);
  }
  return difference == 0;
}

bool WebGate::has_token(const HttpRequest& request) const {
  constexpr const char* kBearer = "Bearer ";
  const std::string& authorization = request.authorization;
  if (authorization.starts_with(kBearer)) {
    return equal_secretly(authorization.substr(std::string(kBearer).size()), token_);
  }
  return equal_secretly(request.token.empty() ? request.cookie : request.token, token_);
}

HttpResponse WebGate::let_in(const HttpRequest& request) const {
  if (token_.empty()) {
    if (!is_this_machine(request.host)) {
      return refusal(kForbidden, "use localhost or 127.0.0.1 in the address");
    }
  } else if (!has_token(request)) {
    HttpResponse response = refusal(kUnauthorized, "this needs the token (control.token)");
    if (request.path == "/") {
      response = token_page();
      response.status = kUnauthorized;
    }
    response.headers.emplace_back("WWW-Authenticate", "Bearer");
    return response;
  }
  if (request.method != "GET" && !request.origin.empty() &&
      request.origin != "http://" + request.host) {
    return refusal(kForbidden, "another site's page may not do that");
  }
  if (!request.token.empty() && request.method == "GET" && request.path == "/") {
    // Out of the address bar and into a cookie that no other site's page can use.
    HttpResponse response;
    response.status = kSeeOther;
    response.headers = {{"Location", "/"},
                        {"Set-Cookie", std::string(kTokenCookie) + "=" + request.token +
                                           "; Path=/; HttpOnly; SameSite=Strict"}};
    return response;
  }
  return inner_(request);
}

HttpResponse WebGate::handle(const HttpRequest& request) const {
  HttpResponse response = let_in(request);
  response.headers.insert(response.headers.end(), {{"X-Content-Type-Options", "nosniff"},
                                                   {"Cross-Origin-Resource-Policy", "same-origin"},
                                                   {"Referrer-Policy", "no-referrer"}});
  return response;
}

}  // namespace roundel
