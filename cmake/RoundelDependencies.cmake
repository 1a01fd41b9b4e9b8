# Libraries, all from Debian 12. ./dev names their packages.

find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(yaml-cpp REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
pkg_check_modules(LCM REQUIRED IMPORTED_TARGET lcm)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo)
find_program(LCM_GEN lcm-gen REQUIRED)

if(ROUNDEL_TESTS)
  find_package(doctest REQUIRED)
  include(doctest)
endif()
