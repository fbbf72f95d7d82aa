# Every library the project uses, by its Debian package (the list to install is deploy/packages.txt).

find_package(Eigen3 REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tl-expected REQUIRED)
find_package(Threads REQUIRED)
find_package(Boost REQUIRED)  # headers only: quantiles

find_package(iceoryx_binding_c REQUIRED)  # Debian's CycloneDDSConfig.cmake does not find it by itself
find_package(iceoryx_posh REQUIRED)
find_package(CycloneDDS REQUIRED)
find_program(IDLC idlc REQUIRED)
find_package(fastcdr REQUIRED)
find_package(fastrtps REQUIRED)
find_program(FASTDDSGEN fastddsgen REQUIRED)

if(QUORIENT_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck QUIET)
endif()
if(QUORIENT_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()
