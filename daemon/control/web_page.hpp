#pragma once

#include "daemon/control/http_message.hpp"

namespace roundel {

// The page of GET /: picture, markers, arena and status, live. One file that asks for nothing from
// elsewhere; its policy lets scripts and styles run only if they are its own.
HttpResponse web_page();

// What is shown in its place to who has no token: a field for it.
HttpResponse token_page();

}  // namespace roundel
