# Python classes of crtk_msgs where that package is not installed (Debian has none), under its own name, so that
# rostopic and stock CRTK clients find them. A catkin package generates messages for its own name only: hence by hand.
find_package(crtk_msgs QUIET CONFIG)
if(crtk_msgs_FOUND OR TARGET crtk_msgs_generate_messages_py)
  message(STATUS "crtk_msgs: installed, nothing generated")
else()
  set(crtk_python_dir "${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_PYTHON_DESTINATION}/crtk_msgs")
  set(crtk_includes
    -I "crtk_msgs:${CMAKE_CURRENT_SOURCE_DIR}/msg/crtk_msgs"
    -I "std_msgs:${std_msgs_PREFIX}/share/std_msgs/msg"
    -I "geometry_msgs:${geometry_msgs_PREFIX}/share/geometry_msgs/msg")
  set(crtk_outputs)
  foreach(kind IN ITEMS msg srv)
    set(crtk_modules)
    file(GLOB crtk_definitions CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${kind}/crtk_msgs/*.${kind}")
    foreach(definition IN LISTS crtk_definitions)
      get_filename_component(name "${definition}" NAME_WE)
      set(module "${crtk_python_dir}/${kind}/_${name}.py")
      add_custom_command(OUTPUT "${module}"
        COMMAND "${PYTHON_EXECUTABLE}" "${GENPY_BIN_DIR}/gen${kind}_py.py" "${definition}" ${crtk_includes}
          -p crtk_msgs -o "${crtk_python_dir}/${kind}"
        DEPENDS "${definition}" COMMENT "Generating Python from crtk_msgs/${name}")
      list(APPEND crtk_modules "${module}")
    endforeach()
    add_custom_command(OUTPUT "${crtk_python_dir}/${kind}/__init__.py"
      COMMAND "${PYTHON_EXECUTABLE}" "${GENPY_BIN_DIR}/genmsg_py.py" --initpy -o "${crtk_python_dir}/${kind}"
      DEPENDS ${crtk_modules} COMMENT "Generating Python __init__.py of crtk_msgs.${kind}")
    list(APPEND crtk_outputs ${crtk_modules} "${crtk_python_dir}/${kind}/__init__.py")
  endforeach()
  file(MAKE_DIRECTORY "${crtk_python_dir}/msg" "${crtk_python_dir}/srv")
  file(WRITE "${crtk_python_dir}/__init__.py" "")
  add_custom_target(saras_crtk_msgs ALL DEPENDS ${crtk_outputs})
  install(DIRECTORY "${crtk_python_dir}" DESTINATION "${CATKIN_GLOBAL_PYTHON_DESTINATION}")
endif()
