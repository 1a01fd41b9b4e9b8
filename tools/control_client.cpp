#include "tools/control_client.hpp"

#include <curl/curl.h>
#include <fmt/format.h>

#include <cstring>
#include <memory>
#include <stdexcept>

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxAnswer = std::size_t{64} << 20;
constexpr long kTimeoutSeconds = 20;

struct CloseCurl {
  void operator()(CURL* curl) const { curl_easy_cleanup(curl); }
};

std::size_t append(char* data, std::size_t, std::size_t size, void* out) {
  auto& text = *static_cast<std::string*>(out);
  if (text.size() + size > kMaxAnswer) return 0;
  text.append(data, size);
  return size;
}

Json parse(const std::string& text) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error&) {
    throw std::runtime_error("roundeld answered with something that is not JSON");
  }
}

// What roundeld says is wrong.
std::string error_in(const std::string& body, long status) {
  const Json json = Json::parse(body, nullptr, false);
  if (json.is_object() && json.contains("error") && json["error"].is_string()) {
    return json["error"].get<std::string>();
  }
  return fmt::format("roundeld answered with HTTP status {}", status);
}

}  // namespace

CLI::Option* add_socket_option(CLI::App& command, std::string& socket) {
  return command.add_option("--socket", socket, "Control socket of roundeld (control.socket)")
      ->type_name("PATH")
      ->capture_default_str();
}

std::string ControlClient::request(const std::string& method, const std::string& path,
                                   const std::string& body) const {
  const std::unique_ptr<CURL, CloseCurl> curl(curl_easy_init());
  if (!curl) throw std::runtime_error("libcurl can't be used");
  std::string answer;
  const std::string url = "http://roundeld" + path;
  curl_easy_setopt(curl.get(), CURLOPT_URL, url.c_str());
  curl_easy_setopt(curl.get(), CURLOPT_UNIX_SOCKET_PATH, socket_.c_str());
  curl_easy_setopt(curl.get(), CURLOPT_CUSTOMREQUEST, method.c_str());
  curl_easy_setopt(curl.get(), CURLOPT_NOPROXY, "*");
  curl_easy_setopt(curl.get(), CURLOPT_TIMEOUT, kTimeoutSeconds);
  curl_easy_setopt(curl.get(), CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEFUNCTION, append);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEDATA, &answer);
  if (method != "GET") {
    curl_easy_setopt(curl.get(), CURLOPT_POSTFIELDS, body.c_str());
    curl_easy_setopt(curl.get(), CURLOPT_POSTFIELDSIZE, static_cast<long>(body.size()));
  }
  const CURLcode code = curl_easy_perform(curl.get());
  if (code != CURLE_OK) {
    long reason = 0;
    curl_easy_getinfo(curl.get(), CURLINFO_OS_ERRNO, &reason);
    throw ControlError(0, fmt::format("roundeld can't be reached at {}: {}; is it running, with "
                                      "this control.socket, and are you "
                                      "a member of its group?",
                                      socket_,
                                      code == CURLE_COULDNT_CONNECT && reason != 0
                                          ? std::strerror(static_cast<int>(reason))
                                          : curl_easy_strerror(code)));
  }
  long status = 0;
  curl_easy_getinfo(curl.get(), CURLINFO_RESPONSE_CODE, &status);
  constexpr long kFirstError = 400;
  if (status >= kFirstError) throw ControlError(status, error_in(answer, status));
  return answer;
}

Json ControlClient::get(const std::string& path) const {
  return parse(request("GET", path));
}

Json ControlClient::send(const std::string& method, const std::string& path,
                         const Json& body) const {
  return parse(request(method, path, body.dump()));
}

}  // namespace roundel
