# The module again for each Python whose headers are in MESOGRAIN_PORTABLE, as pythons/3.X/include/python3.X, with a pybind11 in
# libraries/include that knows them all; and for this machine's own. Only the bindings differ.
file(GLOB PYTHONS ${MESOGRAIN_PORTABLE}/pythons/3.*)
# Headers take most of a binding's time, so a Python's bindings are compiled as one text, but for one that shares a name.
set_source_files_properties(bind_view.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)

# Who calls libraries that Blender has in other versions.
set(CALLERS mesograin_embree mesograin_transport mesograin_heap mesograin_casting mesograin_render)
list(TRANSFORM CALLERS REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE ARCHIVES)
set(FORWARDS ${CMAKE_CURRENT_BINARY_DIR}/forwards.cpp)
add_custom_command(
  OUTPUT ${FORWARDS}
  COMMAND ${Python_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/make_forwards.py ${FORWARDS} ${CMAKE_NM} ${ARCHIVES}
  DEPENDS make_forwards.py ${CALLERS}
  VERBATIM)
add_library(mesograin_forwards OBJECT EXCLUDE_FROM_ALL ${FORWARDS})

add_custom_target(portable)
function(add_portable_module NAME ABI)
  add_library(${NAME} MODULE EXCLUDE_FROM_ALL ${ARGN} $<TARGET_OBJECTS:mesograin_forwards>)
  target_link_libraries(${NAME} PRIVATE ${ROOMS})
  # The linker sees no call to what the forwards call.
  target_link_options(${NAME} PRIVATE LINKER:--no-as-needed)
  set_target_properties(
    ${NAME} PROPERTIES EXPORT_COMPILE_COMMANDS OFF LINKER_LANGUAGE CXX DEFINE_SYMBOL "" PREFIX "" OUTPUT_NAME mesograin_native
                       SUFFIX .cpython-${ABI}-x86_64-linux-gnu.so LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/portable)
  add_dependencies(portable ${NAME})
endfunction()

add_portable_module(mesograin_bindings_own ${Python_VERSION_MAJOR}${Python_VERSION_MINOR} $<TARGET_OBJECTS:mesograin_native>)
foreach(FOLDER IN LISTS PYTHONS)
  get_filename_component(VERSION ${FOLDER} NAME)
  string(REPLACE "." "" ABI ${VERSION})
  set(MODULE mesograin_bindings_${ABI})
  add_portable_module(${MODULE} ${ABI} ${BINDINGS})
  target_include_directories(${MODULE} BEFORE PRIVATE ${MESOGRAIN_PORTABLE}/libraries/include ${FOLDER}/include/python${VERSION} ${FOLDER}/include)
  target_compile_definitions(${MODULE} PRIVATE MESOGRAIN_VERSION="${PROJECT_VERSION}")
  set_target_properties(${MODULE} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
endforeach()
