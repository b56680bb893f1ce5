# Language, warnings and output folders, the same for every target.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

add_compile_options(-ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # The compiler collects garbage seldom: a tenth of its time, for up to 1 GB of memory a process.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:--param=ggc-min-heapsize=600000>)
endif()
# Tests and command lines: optimising them costs more than it gains. The modules that they call keep their options.
# Their own files are not checked for undefined behaviour: the check took a third or more of the time to compile them.
function(trocar_optimise_little target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(CMAKE_CXX_FLAGS MATCHES "undefined")
    target_compile_options(${target} PRIVATE -fno-sanitize=undefined)
  endif()
endfunction()

# TBB's templates, like TBB itself, are compiled without the thread sanitizer, which would report their synchronisation as races.
if(CMAKE_CXX_FLAGS MATCHES "fsanitize=thread")
  set_source_files_properties(${PROJECT_SOURCE_DIR}/src/foundation/core/parallel.cpp PROPERTIES
    SKIP_PRECOMPILE_HEADERS ON COMPILE_OPTIONS "-fno-sanitize=thread;-DTROCAR_THREAD_SANITIZER")
endif()

add_library(trocar_warnings INTERFACE)
target_compile_options(trocar_warnings INTERFACE -Wall -Wextra -Wconversion -Wshadow)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  # What ccache's manual asks for where there are precompiled headers; without a run of the preprocessor of its own.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_DEPEND=1
      ${CCACHE_PROGRAM})
  add_compile_options($<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CXX_COMPILER_ID:GNU>>:-fpch-preprocess>)
endif()
