#include "daemon/control/http_server.hpp"

#include <microhttpd.h>
#include <sys/socket.h>

#include <atomic>
#include <mutex>
#include <stdexcept>
#include <unordered_map>
#include <vector>

namespace roundel {
namespace {

using Clock = std::chrono::steady_clock;

// Bytes; all connections together may well wait for one of these.
constexpr std::size_t kSmallAnswer = std::size_t{64} << 10;

// A request while it arrives.
struct Arriving {
  HttpRequest request;
  bool too_large = false;
};

struct ConnectionState {
  int descriptor = -1;
  Clock::time_point since;
  bool streams = false;
};

}  // namespace

struct HttpServer::Impl {
  // A client that is being sent a stream.
  struct Streaming {
    Impl* server = nullptr;
    MHD_Connection* connection = nullptr;
    std::unique_ptr<HttpStream> stream;
  };

  // An answer until its client has taken it.
  struct Body {
    Impl* server = nullptr;
    std::string text;
  };

  HttpHandler handler;
  HttpLimits limits;
  std::atomic<bool> stopping{false};
  std::atomic<unsigned> streams{0};
  std::atomic<std::size_t> untaken{0};

  std::mutex mutex;  // of the two below
  std::unordered_map<MHD_Connection*, ConnectionState> connections;
  std::vector<MHD_Connection*> suspended;  // streams that have nothing to read

  MHD_Daemon* daemon = nullptr;

  MHD_Result handle(MHD_Connection* connection, const char* url, const char* method,
                    const char* upload, std::size_t* upload_size, void** state);
  MHD_Result answer(MHD_Connection* connection, HttpResponse response);
  MHD_Result answer_by_stream(MHD_Connection* connection, HttpResponse response);
  void note(MHD_Connection* connection, MHD_ConnectionNotificationCode code);
};

namespace {

HttpResponse error_response(int status, const char* what) {
  return {status, "application/json", std::string(R"({"error":")") + what + "\"}\n", "", nullptr};
}

}  // namespace

MHD_Result HttpServer::Impl::handle(MHD_Connection* connection, const char* url, const char* method,
                                    const char* upload, std::size_t* upload_size, void** state) {
  if (*state == nullptr) {
    auto arriving = std::make_unique<Arriving>();
    arriving->request.method = method;
    arriving->request.path = url;
    const auto value = [connection](MHD_ValueKind kind, const char* name) {
      const char* const text = MHD_lookup_connection_value(connection, kind, name);
      return std::string(text == nullptr ? "" : text);
    };
    arriving->request.plain_picture = value(MHD_GET_ARGUMENT_KIND, "overlay") == "0";
    arriving->request.keep_tracks = value(MHD_GET_ARGUMENT_KIND, "restart") == "0";
    arriving->request.token = value(MHD_GET_ARGUMENT_KIND, "token");
    arriving->request.host = value(MHD_HEADER_KIND, MHD_HTTP_HEADER_HOST);
    arriving->request.origin = value(MHD_HEADER_KIND, MHD_HTTP_HEADER_ORIGIN);
    arriving->request.authorization = value(MHD_HEADER_KIND, MHD_HTTP_HEADER_AUTHORIZATION);
    arriving->request.cookie = value(MHD_COOKIE_KIND, kTokenCookie);
    const char* const length =
        MHD_lookup_connection_value(connection, MHD_HEADER_KIND, MHD_HTTP_HEADER_CONTENT_LENGTH);
    // Refused before it is sent; the connection ends with the answer.
    if (length != nullptr && std::strtoull(length, nullptr, 10) > limits.body) {
      return answer(connection, error_response(413, "the request is too large"));
    }
    *state = arriving.release();
    return MHD_YES;
  }
  auto& arriving = *static_cast<Arriving*>(*state);
  if (*upload_size > 0) {
    if (arriving.request.body.size() + *upload_size > limits.body) return MHD_NO;
    arriving.request.body.append(upload, *upload_size);
    *upload_size = 0;
    return MHD_YES;
  }
  return answer(connection, handler(arriving.request));
}

MHD_Result HttpServer::Impl::answer(MHD_Connection* connection, HttpResponse response) {
  if (response.stream) return answer_by_stream(connection, std::move(response));
  const std::size_t before = untaken, size = response.body.size();
  if (size > kSmallAnswer && before > 0 && before + size > limits.untaken) {
    response = error_response(503, "too many clients have not taken their answers");
  }
  auto body = std::make_unique<Body>(Body{this, std::move(response.body)});
  const auto free = [](void* self) {
    const std::unique_ptr<Body> taken(static_cast<Body*>(self));
    taken->server->untaken -= taken->text.size();
  };
  MHD_Response* const made = MHD_create_response_from_buffer_with_free_callback_cls(
      body->text.size(), body->text.data(), free, body.get());
  if (made == nullptr) return MHD_NO;
  untaken += body->text.size();
  [[maybe_unused]] const Body* const owned = body.release();
  MHD_add_response_header(made, MHD_HTTP_HEADER_CONTENT_TYPE, response.type.c_str());
  MHD_add_response_header(made, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
  for (const auto& [name, text] : response.headers) {
    MHD_add_response_header(made, name.c_str(), text.c_str());
  }
  if (!response.allow.empty()) {
    MHD_add_response_header(made, MHD_HTTP_HEADER_ALLOW, response.allow.c_str());
  }
  const MHD_Result result =
      MHD_queue_response(connection, static_cast<unsigned>(response.status), made);
  MHD_destroy_response(made);
  return result;
}

MHD_Result HttpServer::Impl::answer_by_stream(MHD_Connection* connection, HttpResponse response) {
  if (++streams > limits.streams) {
    --streams;
    return answer(connection, error_response(503, "too many streams"));
  }
  auto* const streaming = new Streaming{this, connection, std::move(response.stream)};
  const auto read = [](void* self, std::uint64_t, char* out, std::size_t room) -> ssize_t {
    Streaming& s = *static_cast<Streaming*>(self);
    // Under the lock, so that no call to wake up is missed between looking and suspending.
    const std::lock_guard lock(s.server->mutex);
    if (s.server->stopping) return MHD_CONTENT_READER_END_OF_STREAM;
    const std::size_t size = s.stream->read(out, room);
    if (size == 0) {
      MHD_suspend_connection(s.connection);
      s.server->suspended.push_back(s.connection);
    }
    return static_cast<ssize_t>(size);
  };
  const auto free = [](void* self) {
    auto* const s = static_cast<Streaming*>(self);
    --s->server->streams;
    delete s;
  };
  constexpr std::size_t kBlock = 16384;
  MHD_Response* const made =
      MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, kBlock, read, streaming, free);
  if (made == nullptr) {
    free(streaming);
    return MHD_NO;
  }
  MHD_add_response_header(made, MHD_HTTP_HEADER_CONTENT_TYPE, response.type.c_str());
  MHD_add_response_header(made, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
  {
    const std::lock_guard lock(mutex);
    connections[connection].streams = true;
  }
  const MHD_Result result = MHD_queue_response(connection, MHD_HTTP_OK, made);
  MHD_destroy_response(made);
  return result;
}

void HttpServer::Impl::note(MHD_Connection* connection, MHD_ConnectionNotificationCode code) {
  const std::lock_guard lock(mutex);
  if (code == MHD_CONNECTION_NOTIFY_CLOSED) {
    connections.erase(connection);
    std::erase(suspended, connection);
    return;
  }
  const MHD_ConnectionInfo* const information =
      MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
  connections[connection] = {information == nullptr ? -1 : information->connect_fd, Clock::now(),
                             false};
}

HttpServer::HttpServer(UniqueFd listening, HttpHandler handler, const HttpLimits& limits)
    : impl_(std::make_unique<Impl>()) {
  impl_->handler = std::move(handler);
  impl_->limits = limits;
  const auto handle = [](void* self, MHD_Connection* connection, const char* url,
                         const char* method, const char*, const char* upload,
                         std::size_t* upload_size, void** state) -> MHD_Result {
    return static_cast<Impl*>(self)->handle(connection, url, method, upload, upload_size, state);
  };
  const auto completed = [](void*, MHD_Connection*, void** state, MHD_RequestTerminationCode) {
    delete static_cast<Arriving*>(*state);
    *state = nullptr;
  };
  const auto note = [](void* self, MHD_Connection* connection, void**,
                       MHD_ConnectionNotificationCode code) {
    static_cast<Impl*>(self)->note(connection, code);
  };
  impl_->daemon = MHD_start_daemon(
      MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME, 0, nullptr, nullptr,
      static_cast<MHD_AccessHandlerCallback>(handle), impl_.get(),                        //
      MHD_OPTION_LISTEN_SOCKET, listening.get(),                                          //
      MHD_OPTION_CONNECTION_LIMIT, limits.connections,                                    //
      MHD_OPTION_CONNECTION_MEMORY_LIMIT, limits.memory,                                  //
      MHD_OPTION_CONNECTION_TIMEOUT, static_cast<unsigned>(limits.idle.count()),          //
      MHD_OPTION_NOTIFY_COMPLETED, static_cast<MHD_RequestCompletedCallback>(completed),  //
      nullptr, MHD_OPTION_NOTIFY_CONNECTION, static_cast<MHD_NotifyConnectionCallback>(note),
      impl_.get(), MHD_OPTION_END);
  if (impl_->daemon == nullptr) throw std::runtime_error("the HTTP server can't be started");
  listening.release();  // the server closes it
}

HttpServer::~HttpServer() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stopping = true;
  }
  wake_streams();
  MHD_stop_daemon(impl_->daemon);
}

void HttpServer::wake_streams() {
  const std::lock_guard lock(impl_->mutex);
  for (MHD_Connection* const connection : impl_->suspended) MHD_resume_connection(connection);
  impl_->suspended.clear();
}

void HttpServer::end_overdue() {
  const Clock::time_point latest = Clock::now() - impl_->limits.whole;
  const std::lock_guard lock(impl_->mutex);
  for (const auto& [connection, state] : impl_->connections) {
    if (!state.streams && state.since < latest) ::shutdown(state.descriptor, SHUT_RDWR);
  }
}

}  // namespace roundel
