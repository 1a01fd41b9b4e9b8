#include "daemon/control/web_page.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>

#include "daemon/control/page_html.hpp"

namespace roundel {
namespace {

// New for every answer: a script that somebody smuggled into the page would not know it.
std::string make_nonce() {
  std::array<unsigned char, 16> bytes{};
  std::string nonce;
  // Without one, the page's policy lets nothing run.
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return nonce;
  for (const unsigned char byte : bytes) nonce += fmt::format("{:02x}", byte);
  return nonce;
}

HttpResponse page(std::string_view html) {
  constexpr std::string_view kPlace = "NONCE";
  const std::string nonce = make_nonce();
  HttpResponse response;
  response.type = "text/html; charset=utf-8";
  response.body = html;
  for (std::size_t at = 0; (at = response.body.find(kPlace, at)) != std::string::npos;) {
    response.body.replace(at, kPlace.size(), nonce);
  }
  response.headers = {
      {"Content-Security-Policy",
       fmt::format("default-src 'none'; script-src 'nonce-{0}'; style-src 'nonce-{0}'; img-src "
                   "'self' blob: data:; connect-src 'self'; form-action 'self'; base-uri 'none'; "
                   "frame-ancestors 'none'",
                   nonce)}};
  return response;
}

}  // namespace

HttpResponse web_page() {
  return page(page_html());
}

HttpResponse token_page() {
  return page(R"(<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Roundel</title>
<style nonce="NONCE">:root{color-scheme:light dark}body{font:1rem system-ui;margin:3rem auto;max-width:24rem;padding:0 1rem}
input,button{font:inherit;padding:.4rem .6rem}</style>
<h1>Roundel</h1>
<form action="/"><p><label>Token (<code>control.token</code> of roundeld)<br>
<input name="token" type="password" autocomplete="current-password" autofocus required></label>
<button>Open</button></p></form></html>
)");
}

}  // namespace roundel
