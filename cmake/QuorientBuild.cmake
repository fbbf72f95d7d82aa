# How every target of the project is built: the language, the warnings, the sanitizers, and one function per kind of target.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
add_compile_options(-fPIC) # the same for libraries and programs, which share precompiled headers
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME quorient)
include(GNUInstallDirs)
include(CTest)
include(GoogleTest)

find_program(CCACHE ccache)
if(CCACHE)
  # What ccache's manual asks for where headers are precompiled. CCACHE_BASEDIR lets two checkouts share their
  # results, but not those of sources compiled as one, which name their files by full paths.
  set(launcher ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_PCH_EXTSUM=1 ${CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
endif()

# What is shipped is compiled as Debian compiles its own packages (`DEB_BUILD_MAINT_OPTIONS=hardening=+all dpkg-buildflags`), with two more flags
# that newer releases of it have. Debug builds and sanitizers have checks of their own, and tests are not installed.
set(hardening -fstack-protector-strong -fstack-clash-protection -D_FORTIFY_SOURCE=2 -Wformat -Werror=format-security
    # The checks are inlined, and g++ may suspect overruns in them where there are none: that is no reason to end a build.
    -Wno-error=restrict -Wno-error=stringop-overflow)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|amd64|i.86)$")
  list(APPEND hardening -fcf-protection)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  list(APPEND hardening -mbranch-protection=standard)
endif()
if(CMAKE_BUILD_TYPE STREQUAL Release AND NOT QUORIENT_SANITIZE)
  set(QUORIENT_HARDENED ON)
  add_compile_options("$<$<NOT:$<BOOL:$<TARGET_PROPERTY:QUORIENT_TEST>>>:${hardening}>")
  add_link_options(LINKER:-z,relro,-z,now $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-pie>)
endif()

# Before any target, also before the precompiled headers, which must be compiled with the same flags.
if(QUORIENT_SANITIZE)
  # Under -fsanitize g++ 12 sees uninitialised members of std::optional and std::regex where there are none (GCC bug 105562).
  add_compile_options(-fsanitize=${QUORIENT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_link_options(-fsanitize=${QUORIENT_SANITIZE})
endif()
if(QUORIENT_COVERAGE)
  add_compile_options(--coverage)
  add_link_options(--coverage)
endif()

# Linked by our own targets only: generated vendor code is not ours to warn about.
add_library(quorient_warnings INTERFACE)
target_compile_options(quorient_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror
  # With precompiled headers g++ 12 sees strings overrun inside the standard library where they are not (GCC bug 105329).
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-array-bounds$<SEMICOLON>-Wno-stringop-overread>)

if(FASTDDS_LIBRARY STREQUAL fastdds)
  # tinyxml2, below Fast DDS, defines this for its users there. A precompiled header serves only sources with the same definition.
  add_compile_definitions(_FILE_OFFSET_BITS=64)
endif()

# Precompiled headers: what nearly every source of a kind includes, parsed once. Sources still include what they use; a build with
# -DQUORIENT_PRECOMPILE=OFF shows one that does not.
option(QUORIENT_PRECOMPILE "Precompile the headers of libraries that most sources include" ON)
set(precompiled_core <Eigen/Dense> <fmt/format.h> <tl/expected.hpp> <algorithm> <array> <bit> <cmath> <cstdint> <filesystem> <functional> <limits>
    <memory> <numeric> <optional> <span> <string> <string_view> <vector>)

# quorient_precompiled(NAME HEADERS <a> … DEPENDS target … [OPTIONS flag …]): a set of precompiled headers for targets with these flags.
function(quorient_precompiled name)
  if(NOT QUORIENT_PRECOMPILE)
    return()
  endif()
  cmake_parse_arguments(arg "" "" "HEADERS;DEPENDS;OPTIONS" ${ARGN})
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled/${name}.cpp CONTENT "\n")  # written once: a new time would compile it again
  add_library(precompiled_${name} OBJECT ${CMAKE_BINARY_DIR}/precompiled/${name}.cpp)
  target_compile_options(precompiled_${name} PRIVATE ${arg_OPTIONS})
  target_link_libraries(precompiled_${name} PRIVATE ${arg_DEPENDS} quorient_warnings)
  target_precompile_headers(precompiled_${name} PRIVATE ${arg_HEADERS})
  # ccache hashes this in place of the precompiled file, which is large and differs from one compilation of the same headers to the next.
  string(SHA256 sum "${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_BUILD_TYPE} ${CMAKE_CXX_FLAGS_RELWITHDEBINFO} ${arg_HEADERS} ${arg_OPTIONS} ${hardening} ${QUORIENT_SANITIZE}
    ${QUORIENT_COVERAGE} ${Eigen3_VERSION} ${fmt_VERSION} ${tl-expected_VERSION} ${nlohmann_json_VERSION} ${GTest_VERSION}")
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/precompiled_${name}.dir/cmake_pch.hxx.gch.sum "${sum}")
endfunction()

# quorient_precompile(TARGET NAME): compiles a target with the headers of quorient_precompiled(NAME).
function(quorient_precompile target name)
  if(QUORIENT_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM precompiled_${name})
    target_compile_definitions(${target} PRIVATE $<TARGET_PROPERTY:fmt::fmt,INTERFACE_COMPILE_DEFINITIONS>)
  endif()
endfunction()

# Tests need not be fast: what they test is built with the full optimisation.
set(test_options $<$<CONFIG:Release>:-O1>)
quorient_precompiled(core HEADERS ${precompiled_core} DEPENDS Eigen3::Eigen fmt::fmt tl::expected)
# Nor need what runs once: command lines, reports, configuration. Optimised for size it compiles in half the time.
set(cold_options $<$<CONFIG:Release>:-Os>)
quorient_precompiled(cold HEADERS ${precompiled_core} <nlohmann/json.hpp> <map> <sstream>
  DEPENDS Eigen3::Eigen fmt::fmt tl::expected nlohmann_json::nlohmann_json OPTIONS ${cold_options})
if(QUORIENT_TESTS)
  quorient_precompiled(test HEADERS ${precompiled_core} <gtest/gtest.h> <gmock/gmock.h> <random>
    DEPENDS Eigen3::Eigen fmt::fmt tl::expected GTest::gtest GTest::gmock OPTIONS ${test_options})
  if(QUORIENT_PRECOMPILE)
    set_target_properties(precompiled_test PROPERTIES QUORIENT_TEST ON)
  endif()
endif()

# Sources of a room are compiled several at a time, since headers and templates are then compiled once for all of them (deploy/README.md has times). So a name in an
# anonymous namespace occurs once in a room. While you change sources, -DQUORIENT_UNITY=OFF compiles only those (the dev preset has it).
option(QUORIENT_UNITY "Compile several sources of a room as one" ON)

function(quorient_unity target)
  get_target_property(sources ${target} SOURCES)
  list(LENGTH sources count)
  if(QUORIENT_UNITY AND count GREATER 1)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 32)
  endif()
endfunction()

# quorient_cold(TARGET): compiles a target that runs once, not per frame.
function(quorient_cold target)
  target_compile_options(${target} PRIVATE ${cold_options})
  quorient_precompile(${target} cold)
endfunction()

# quorient_library(ROOM [COLD] SOURCES a.cpp … [DEPENDS target …] [PRIVATE_DEPENDS target …])
# One folder of common/ = one target quorient_ROOM = one namespace. Headers live in include/quorient/ROOM/. COLD: as quorient_cold().
function(quorient_library room)
  cmake_parse_arguments(arg "COLD" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  if(arg_SOURCES)
    add_library(quorient_${room} STATIC ${arg_SOURCES})
    target_include_directories(quorient_${room} PUBLIC
      $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(quorient_${room} PUBLIC ${arg_DEPENDS} PRIVATE ${arg_PRIVATE_DEPENDS} $<BUILD_INTERFACE:quorient_warnings>)
    quorient_unity(quorient_${room})
    if(arg_COLD)
      quorient_cold(quorient_${room})
    else()
      quorient_precompile(quorient_${room} core)
    endif()
  else()
    add_library(quorient_${room} INTERFACE)
    target_include_directories(quorient_${room} INTERFACE
      $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(quorient_${room} INTERFACE ${arg_DEPENDS})
  endif()
  add_library(quorient::${room} ALIAS quorient_${room})
  set_target_properties(quorient_${room} PROPERTIES EXPORT_NAME ${room})
endfunction()

# quorient_test(NAME SOURCES a_test.cpp … [DEPENDS target …] [TIMEOUT seconds] [ENVIRONMENT name=value]): one GoogleTest program, one ctest entry per test.
function(quorient_test name)
  if(NOT QUORIENT_TESTS)
    return()
  endif()
  cmake_parse_arguments(arg "" "TIMEOUT;ENVIRONMENT" "SOURCES;DEPENDS" ${ARGN})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
  endif()
  if(QUORIENT_SANITIZE)
    math(EXPR arg_TIMEOUT "5 * ${arg_TIMEOUT}")
    # Not beside it in ENVIRONMENT: gtest_discover_tests takes a list apart and keeps its first variable alone.
    set(sanitizer_environment ENVIRONMENT_MODIFICATION TSAN_OPTIONS=set:suppressions=${PROJECT_SOURCE_DIR}/deploy/sanitizers/thread.supp)
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_DEPENDS} GTest::gtest GTest::gmock GTest::gtest_main quorient_warnings)
  target_compile_options(${name} PRIVATE ${test_options})
  set_target_properties(${name} PROPERTIES QUORIENT_TEST ON)
  quorient_precompile(${name} test)
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT ${arg_TIMEOUT} ${sanitizer_environment}
    ENVIRONMENT "${arg_ENVIRONMENT}")
endfunction()

# quorient_benchmark(NAME SOURCES a.cpp … [DEPENDS target …]): a Google Benchmark program; never a test.
function(quorient_benchmark name)
  if(NOT QUORIENT_BENCHMARKS)
    return()
  endif()
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_DEPENDS} benchmark::benchmark quorient_warnings)
endfunction()
