# How every target of the project is built: the language, the warnings, the sanitizers, and one function per kind of target.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME quorient)
include(GNUInstallDirs)
include(CTest)
include(GoogleTest)

find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

# Linked by our own targets only: generated vendor code is not ours to warn about.
add_library(quorient_warnings INTERFACE)
target_compile_options(quorient_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror)

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

# quorient_library(ROOM SOURCES a.cpp … [DEPENDS target …] [PRIVATE_DEPENDS target …])
# One folder of common/ = one target quorient_ROOM = one namespace. Headers live in include/quorient/ROOM/.
function(quorient_library room)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  if(arg_SOURCES)
    add_library(quorient_${room} STATIC ${arg_SOURCES})
    target_include_directories(quorient_${room} PUBLIC
      $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(quorient_${room} PUBLIC ${arg_DEPENDS} PRIVATE ${arg_PRIVATE_DEPENDS} $<BUILD_INTERFACE:quorient_warnings>)
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
