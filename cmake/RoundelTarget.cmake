# One place for what every target of the project shares: the standard, the warnings, the sanitizers.

# Reads headers once a target where sanitizers make every compilation dear. Elsewhere each source stands
# alone, so that a missing include shows.
function(roundel_precompile target)
  if(ROUNDEL_SANITIZE)
    target_precompile_headers(${target} PRIVATE ${ARGN})
    # For compiler caches.
    target_compile_options(${target} PRIVATE -fpch-preprocess)
  endif()
endfunction()

function(roundel_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
  target_link_options(${target} PRIVATE -Wl,-z,relro,-z,now)  # what is linked can't be redirected
  if(ROUNDEL_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(ROUNDEL_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${ROUNDEL_SANITIZE} -fno-omit-frame-pointer
      # GCC takes what the sanitizers add for uses of uninitialised values, in std::regex for one.
      -Wno-maybe-uninitialized)
    target_link_options(${target} PUBLIC -fsanitize=${ROUNDEL_SANITIZE})
    if(ROUNDEL_SANITIZE MATCHES "undefined")
      # The checks of every single access double the time to build, and find little that the address
      # sanitizer does not.
      target_compile_options(${target} PRIVATE -fno-sanitize-recover=undefined
        -fno-sanitize=null,alignment,vptr,object-size)
    endif()
    roundel_precompile(${target} <Eigen/Geometry> <algorithm> <chrono> <cmath> <functional> <memory>
      <optional> <span> <string> <vector>)
  endif()
endfunction()

# A library of one folder: roundel_library(core a.cpp b.cpp) makes the target roundel_core.
function(roundel_library folder)
  add_library(roundel_${folder} STATIC ${ARGN})
  roundel_target(roundel_${folder})
endfunction()

# A doctest program: every TEST_CASE becomes a test of its own in ctest.
function(roundel_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES} ${PROJECT_SOURCE_DIR}/tests/doctest_main.cpp)
  roundel_target(${name})
  # What is tested is in libraries, which are optimised in full; the checks themselves need not be,
  # and take half the time to build.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} doctest::doctest)
  set(timeout 600)
  if(CMAKE_CROSSCOMPILING)
    set(timeout 3600)  # an emulator is some twenty times slower
  endif()
  doctest_discover_tests(${name} TEST_PREFIX "${name}: " PROPERTIES TIMEOUT ${timeout})
endfunction()

# Only the sources named get the path of tests/data: it differs between checkouts, and with it what a
# compiler cache can use again.
function(roundel_test_data)
  set_property(SOURCE ${ARGN} APPEND PROPERTY
    COMPILE_DEFINITIONS ROUNDEL_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
endfunction()
