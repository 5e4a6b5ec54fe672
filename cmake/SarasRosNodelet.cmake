# The nodelet visual_feedback and its standalone program. Included after SarasRos: it needs the generated messages.
# Package by package: another find_package(catkin COMPONENTS …) would replace what the first one found.
set(saras_nodelet_packages nodelet pluginlib image_transport tf2_ros roscpp diagnostic_msgs)
foreach(package IN LISTS saras_nodelet_packages)
  find_package(${package} QUIET CONFIG)
  if(NOT ${package}_FOUND)
    message(STATUS "no nodelet visual_feedback: ${package} is missing (script/bootstrap installs it)")
    return()
  endif()
endforeach()

add_library(saras_visual_feedback SHARED
  saras_ros1/nodelet/awareness_source.cpp
  saras_ros1/nodelet/overlay_messages.cpp
  saras_ros1/nodelet/overlay_sources.cpp
  saras_ros1/nodelet/parameters.cpp
  saras_ros1/nodelet/stiffness_source.cpp
  saras_ros1/nodelet/visual_feedback.cpp)
target_link_libraries(saras_visual_feedback PRIVATE saras::core saras_compiler_options)
add_executable(saras_visual_feedback_node saras_ros1/nodelet/visual_feedback_main.cpp)
target_link_libraries(saras_visual_feedback_node PRIVATE saras_compiler_options)
set_target_properties(saras_visual_feedback_node PROPERTIES OUTPUT_NAME visual_feedback
  RUNTIME_OUTPUT_DIRECTORY "${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION}")
set_target_properties(saras_visual_feedback PROPERTIES LIBRARY_OUTPUT_DIRECTORY "${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_LIB_DESTINATION}")
foreach(target IN ITEMS saras_visual_feedback saras_visual_feedback_node)
  add_dependencies(${target} ${PROJECT_NAME}_generate_messages_cpp)
  target_include_directories(${target} SYSTEM PRIVATE "${CATKIN_DEVEL_PREFIX}/include")
  foreach(package IN LISTS saras_nodelet_packages)
    target_include_directories(${target} SYSTEM PRIVATE ${${package}_INCLUDE_DIRS})
    target_link_libraries(${target} PRIVATE ${${package}_LIBRARIES})
  endforeach()
endforeach()

install(TARGETS saras_visual_feedback LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
install(TARGETS saras_visual_feedback_node RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(FILES nodelet_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
