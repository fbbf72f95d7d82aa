# Every library the project uses, by its Debian package (the list to install is deploy/packages.txt).

find_package(Eigen3 REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tl-expected REQUIRED)
find_package(Threads REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(tinyxml2 REQUIRED)
find_package(Boost REQUIRED CONFIG)  # headers only: quantiles
# Logs: compressed ones, and ROS 2 bags.
find_package(PkgConfig REQUIRED)
find_package(ZLIB REQUIRED)
find_package(zstd REQUIRED)
find_package(SQLite3 REQUIRED)
pkg_check_modules(lz4 REQUIRED IMPORTED_TARGET GLOBAL liblz4)
# Debian has two configurations of that name, for C and for C++; the C one is wanted.
set(CMAKE_FIND_PACKAGE_SORT_ORDER NAME)
set(CMAKE_FIND_PACKAGE_SORT_DIRECTION ASC)
find_package(NLopt REQUIRED)
pkg_check_modules(httplib REQUIRED IMPORTED_TARGET cpp-httplib)  # its flags decide the layout of its classes
find_library(PROMETHEUS_CORE prometheus-cpp-core REQUIRED)  # prometheus-cpp's own configuration asks for libraries that only its other parts need

find_package(iceoryx_binding_c REQUIRED)  # Debian's CycloneDDSConfig.cmake does not find it by itself
find_package(iceoryx_posh REQUIRED)
find_package(CycloneDDS REQUIRED)
find_program(IDLC idlc REQUIRED)
include(${PROJECT_SOURCE_DIR}/idl/examples/fastdds.cmake)

if(QUORIENT_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck QUIET)
endif()
if(QUORIENT_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()
