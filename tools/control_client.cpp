#include "tools/control_client.hpp"

#include <curl/curl.h>
#include <fmt/format.h>

#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxAnswer = std::size_t{64} << 20;
constexpr long kTimeoutSeconds = 20;
constexpr long kStreamBuffer = 512L << 10;
constexpr long kFirstError = 400;

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

using CurlPointer = std::unique_ptr<CURL, CloseCurl>;

CurlPointer make_curl(const std::string& socket, const std::string& path) {
  CurlPointer curl(curl_easy_init());
  if (!curl) throw std::runtime_error("libcurl can't be used");
  // libcurl copies text.
  curl_easy_setopt(curl.get(), CURLOPT_URL, ("http://roundeld" + path).c_str());
  curl_easy_setopt(curl.get(), CURLOPT_UNIX_SOCKET_PATH, socket.c_str());
  curl_easy_setopt(curl.get(), CURLOPT_NOPROXY, "*");
  curl_easy_setopt(curl.get(), CURLOPT_NOSIGNAL, 1L);
  return curl;
}

long status_of(CURL* curl) {
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  return status;
}

[[noreturn]] void throw_unreachable(const CurlPointer& curl, CURLcode code,
                                    const std::string& socket) {
  long reason = 0;
  curl_easy_getinfo(curl.get(), CURLINFO_OS_ERRNO, &reason);
  throw ControlError(0, fmt::format("roundeld can't be reached at {}: {}; is it running, with this "
                                    "control.socket, and are you "
                                    "a member of its group?",
                                    socket,
                                    code == CURLE_COULDNT_CONNECT && reason != 0
                                        ? std::strerror(static_cast<int>(reason))
                                        : curl_easy_strerror(code)));
}

}  // namespace

CLI::Option* add_socket_option(CLI::App& command, std::string& socket) {
  return command.add_option("--socket", socket, "Control socket of roundeld (control.socket)")
      ->type_name("PATH")
      ->capture_default_str();
}

std::string ControlClient::request(const std::string& method, const std::string& path,
                                   const std::string& body) const {
  const CurlPointer curl = make_curl(socket_, path);
  std::string answer;
  curl_easy_setopt(curl.get(), CURLOPT_CUSTOMREQUEST, method.c_str());
  curl_easy_setopt(curl.get(), CURLOPT_TIMEOUT, kTimeoutSeconds);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEFUNCTION, append);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEDATA, &answer);
  if (method != "GET") {
    curl_easy_setopt(curl.get(), CURLOPT_POSTFIELDS, body.c_str());
    curl_easy_setopt(curl.get(), CURLOPT_POSTFIELDSIZE, static_cast<long>(body.size()));
  }
  if (const CURLcode code = curl_easy_perform(curl.get()); code != CURLE_OK) {
    throw_unreachable(curl, code, socket_);
  }
  if (const long status = status_of(curl.get()); status >= kFirstError) {
    throw ControlError(status, error_in(answer, status));
  }
  return answer;
}

namespace {

// One stream as libcurl's callbacks see it. They are C, so that errors wait here.
struct Streaming {
  CURL* curl = nullptr;
  const std::function<bool(std::string_view)>& take;
  const std::function<bool()>& go_on;
  std::string error_body;
  bool wanted = true;
  std::exception_ptr error;

  std::size_t receive(std::string_view data) {
    if (status_of(curl) >= kFirstError) {
      error_body.append(data.substr(0, kMaxAnswer - error_body.size()));
      return data.size();
    }
    try {
      wanted = wanted && take(data);
    } catch (...) {
      error = std::current_exception();
      wanted = false;
    }
    return wanted ? data.size() : 0;
  }

  static std::size_t write(char* data, std::size_t, std::size_t size, void* self) {
    return static_cast<Streaming*>(self)->receive({data, size});
  }
  static int progress(void* self, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
    Streaming& s = *static_cast<Streaming*>(self);
    s.wanted = s.wanted && s.go_on();
    return s.wanted ? 0 : 1;
  }
};

}  // namespace

void ControlClient::stream(const std::string& path,
                           const std::function<bool(std::string_view)>& take,
                           const std::function<bool()>& go_on) const {
  const CurlPointer curl = make_curl(socket_, path);
  Streaming streaming{curl.get(), take, go_on, "", true, nullptr};
  curl_easy_setopt(curl.get(), CURLOPT_CUSTOMREQUEST, "POST");
  curl_easy_setopt(curl.get(), CURLOPT_POSTFIELDS, "");
  curl_easy_setopt(curl.get(), CURLOPT_BUFFERSIZE, kStreamBuffer);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEFUNCTION, &Streaming::write);
  curl_easy_setopt(curl.get(), CURLOPT_WRITEDATA, &streaming);
  curl_easy_setopt(curl.get(), CURLOPT_NOPROGRESS, 0L);
  curl_easy_setopt(curl.get(), CURLOPT_XFERINFOFUNCTION, &Streaming::progress);
  curl_easy_setopt(curl.get(), CURLOPT_XFERINFODATA, &streaming);
  const CURLcode code = curl_easy_perform(curl.get());
  if (streaming.error) std::rethrow_exception(streaming.error);
  if (!streaming.wanted) return;
  const long status = status_of(curl.get());
  // An end without warning is roundeld's.
  if (code != CURLE_OK && status == 0) throw_unreachable(curl, code, socket_);
  if (status >= kFirstError) throw ControlError(status, error_in(streaming.error_body, status));
}

Json ControlClient::get(const std::string& path) const {
  return parse(request("GET", path));
}

Json ControlClient::send(const std::string& method, const std::string& path,
                         const Json& body) const {
  return parse(request(method, path, body.dump()));
}

}  // namespace roundel
