# Language, warnings and output folders, the same for every target.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

add_compile_options(-ffp-contract=off)
# Modules are position independent: they can become part of shared libraries (Python). Nothing replaces one of their functions
# by another of the same name.
add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # The compiler collects garbage seldom: a tenth of its time, for up to 1 GB of memory a process.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:--param=ggc-min-heapsize=600000>)
endif()
# Messages name files below the source folder, whatever the folder in which ccache's object was compiled; from a batch, too.
foreach(prefix IN ITEMS ${PROJECT_SOURCE_DIR}/ ${CMAKE_BINARY_DIR}/unity/../../../)
  add_compile_options(-fmacro-prefix-map=${prefix}=)
endforeach()
set(TROCAR_CHECKS_BEHAVIOUR OFF)
if(CMAKE_CXX_FLAGS MATCHES "sanitize=[a-z,]*undefined")
  set(TROCAR_CHECKS_BEHAVIOUR ON)
endif()

# -O3 is for loops that take long. Elsewhere it costs more than it gains: a third of the time to compile a batch; with sanitizers
# two fifths, even of -O1. Tests have loops: with -O0 the quick ones ran for 265 s under the sanitizers, with -O1 for 166 s.
function(trocar_optimise_little target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(TROCAR_CHECKS_BEHAVIOUR)
    target_compile_options(${target} PRIVATE -O0)
  endif()
endfunction()
# The check of every pointer for null and alignment is two fifths of the time to compile with sanitizers. It finds mistakes in code
# that reads bytes as numbers; null pointers are found by the address sanitizer.
function(trocar_skip_pointer_checks target)
  if(TROCAR_CHECKS_BEHAVIOUR)
    target_compile_options(${target} PRIVATE -fno-sanitize=null,alignment)
  endif()
endfunction()
# Tests and command lines: besides, their own files are not checked for undefined behaviour: the check took a third or more of
# the time to compile them. The modules that they call keep their options.
function(trocar_compile_fast target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(TROCAR_CHECKS_BEHAVIOUR)
    target_compile_options(${target} PRIVATE -fno-sanitize=undefined)
  endif()
endfunction()

# The preset `quick` checks only what reads files of others and talks to devices and clients, and their tests: compiling with
# sanitizers takes about twice as long.
set(TROCAR_SANITIZED all CACHE STRING "Modules under the preset's sanitizers: all or quick (the trait sanitized in src/modules.txt)")
function(trocar_leave_unchecked target)
  target_compile_options(${target} PRIVATE -fno-sanitize=all)
endfunction()

# TBB's templates, like TBB itself, are compiled without the thread sanitizer, which would report their synchronisation as races.
if(CMAKE_CXX_FLAGS MATCHES "fsanitize=thread")
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/foundation/core/parallel.cpp PROPERTIES
    SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS "-fno-sanitize=thread;-DTROCAR_THREAD_SANITIZER")
endif()

add_library(trocar_warnings INTERFACE)
target_compile_options(trocar_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow)

# Objects are found again from another folder: paths below the source folder are taken relative to the build folder, and no flag or
# generated file contains an absolute one, except for prefixes that ccache maps, and tests/source_dir.cpp. `scripts/check` measures it.
# Decided once for a build folder: ./test installs ccache, and what ./run has compiled without it must not be compiled again.
find_program(CCACHE_PROGRAM ccache)
set(TROCAR_CCACHE "${CCACHE_PROGRAM}" CACHE STRING "ccache, or empty")
if(TROCAR_CCACHE AND EXISTS "${TROCAR_CCACHE}")
  # What ccache's manual asks for where there are precompiled headers; without a run of the preprocessor of its own.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_DEPEND=1 ${TROCAR_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${CMAKE_CXX_COMPILER_LAUNCHER})
  add_compile_options($<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-fpch-preprocess>)
endif()
