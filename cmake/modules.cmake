# A module is a folder src/TIER/MODULE: its .cpp files make one library, its test/*_test.cpp one test program.
# What it links is what src/modules.txt allows it to include.

function(trocar_add_modules)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/modules.txt)
  file(STRINGS ${PROJECT_SOURCE_DIR}/src/modules.txt lines REGEX "^[a-z[]")
  foreach(line IN LISTS lines)
    if(line MATCHES "^.([a-z]+).$")
      set(tier ${CMAKE_MATCH_1})
      continue()
    endif()
    string(REPLACE ":" ";" fields "${line}")
    list(GET fields 0 name)
    list(GET fields 1 uses)
    list(GET fields 2 libraries)
    foreach(field IN ITEMS name uses libraries)
      string(STRIP "${${field}}" ${field})
    endforeach()
    separate_arguments(uses)
    separate_arguments(libraries)
    trocar_add_module(${tier} ${name} "${uses}" "${libraries}")
  endforeach()
endfunction()

function(trocar_add_module tier name uses libraries)
  set(tier_folder ${PROJECT_SOURCE_DIR}/src/${tier})
  set(folder ${tier_folder}/${name})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  file(GLOB_RECURSE tests CONFIGURE_DEPENDS ${folder}/test/*.cpp ${folder}/*/test/*.cpp)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${folder}/*.h)
  list(FILTER headers EXCLUDE REGEX "/test(ing)?/")  # these need what a test program defines
  list(REMOVE_ITEM sources ${tests})
  list(FILTER sources EXCLUDE REGEX "/fuzz/")  # built by scripts/fuzz
  list(FILTER tests EXCLUDE REGEX "/test/standin/")  # libraries of their own, by test/standin/CMakeLists.txt
  set(target trocar_${name})
  set(links Eigen3::Eigen fmt::fmt)
  foreach(use IN LISTS uses)
    list(APPEND links trocar_${use})
  endforeach()
  foreach(library IN LISTS libraries)
    list(APPEND links ${trocar_library_${library}})
  endforeach()

  # Schemas of messages: NAME.fbs becomes "MODULE/detail/NAME_generated.h", for the module and its tests; the layer test
  # holds others off detail/.
  file(GLOB schemas CONFIGURE_DEPENDS ${folder}/*.fbs)
  foreach(schema IN LISTS schemas)
    get_filename_component(schema_name ${schema} NAME_WE)
    set(generated ${CMAKE_BINARY_DIR}/generated/${name}/detail/${schema_name}_generated.h)
    get_filename_component(generated_folder ${generated} DIRECTORY)
    add_custom_command(OUTPUT ${generated} DEPENDS ${schema} VERBATIM
      COMMAND ${FLATC} --cpp --scoped-enums --reflect-names -o ${generated_folder} ${schema})
    list(APPEND sources ${generated})
  endforeach()

  if(sources)
    add_library(${target} STATIC ${sources})
    if(schemas)
      target_include_directories(${target} SYSTEM PUBLIC ${CMAKE_BINARY_DIR}/generated)
    endif()
    set(scope PUBLIC)
    target_link_libraries(${target} PUBLIC ${links} PRIVATE trocar_warnings)
    trocar_use_precompiled(${target} trocar_precompiled)
    if("vtk-rendering" IN_LIST libraries)
      vtk_module_autoinit(TARGETS ${target} MODULES VTK::RenderingCore VTK::RenderingOpenGL2
        VTK::RenderingVolumeOpenGL2 VTK::RenderingFreeType)
    endif()
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
    target_link_libraries(${target} INTERFACE ${links})
  endif()
  target_include_directories(${target} ${scope} ${tier_folder})
  # The preset `check` compiles each of these headers alone.
  target_sources(${target} ${scope} FILE_SET HEADERS BASE_DIRS ${tier_folder} FILES ${headers})

  if(TROCAR_TESTS AND tests)
    trocar_add_test(${name} ${target} ${tests})
    include(${folder}/test/standin/CMakeLists.txt OPTIONAL)
  endif()
endfunction()

# Tests are compiled once and run once: optimising them costs more than it gains. What they test keeps its options.
function(trocar_optimise_little target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# One test program of GoogleTest files.
function(trocar_add_test name library)
  add_executable(${name}_test ${ARGN})
  if(NOT TARGET trocar_source_dir)
    add_library(trocar_source_dir STATIC ${PROJECT_SOURCE_DIR}/tests/source_dir.cpp)
    target_include_directories(trocar_source_dir PRIVATE ${PROJECT_SOURCE_DIR}/src/foundation)
    target_compile_definitions(trocar_source_dir PRIVATE TROCAR_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  endif()
  target_link_libraries(${name}_test PRIVATE ${library} trocar_source_dir GTest::gtest_main trocar_warnings)
  trocar_optimise_little(${name}_test)
  if(NOT name STREQUAL "trainer")
    trocar_use_precompiled(${name}_test trocar_precompiled_tests)
  endif()
  set_target_properties(${name}_test PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  set(launcher)
  if(name MATCHES "^(scene|cli|trainer)$")  # VTK and Qt draw on an X server only
    set(launcher ${PROJECT_SOURCE_DIR}/scripts/with_display)
  endif()
  add_test(NAME ${name} COMMAND ${launcher} $<TARGET_FILE:${name}_test>)
  set_tests_properties(${name} PROPERTIES TIMEOUT 600
    ENVIRONMENT "GTEST_BRIEF=1;TROCAR_DATA_DIR=${PROJECT_SOURCE_DIR}/data;TROCAR_BIN_DIR=${CMAKE_BINARY_DIR}/bin;XDG_CACHE_HOME=${CMAKE_BINARY_DIR}/tests/cache")
endfunction()
