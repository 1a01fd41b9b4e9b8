#pragma once

namespace roundel::test {

// Sanitizers and builds without optimisation are many times slower: fewer repetitions there.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__OPTIMIZE__)
inline constexpr bool kSlow = true;
#else
inline constexpr bool kSlow = false;
#endif

}  // namespace roundel::test
