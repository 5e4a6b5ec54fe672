# The nodelet endoscope_capture, its standalone program and the tests of what it does without ROS. Included after
# SarasRosNodelet: both stand in nodelet_plugins.xml.
set(saras_capture_packages nodelet pluginlib image_transport camera_calibration_parsers roscpp diagnostic_msgs)
foreach(package IN LISTS saras_capture_packages)
  find_package(${package} QUIET CONFIG)
  if(NOT ${package}_FOUND)
    message(STATUS "no nodelet endoscope_capture: ${package} is missing (script/bootstrap installs it)")
    return()
  endif()
endforeach()
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(saras_gstreamer QUIET IMPORTED_TARGET gstreamer-1.0 gstreamer-app-1.0 gstreamer-video-1.0 libturbojpeg)
endif()
if(NOT TARGET PkgConfig::saras_gstreamer)
  message(STATUS "no nodelet endoscope_capture: libgstreamer-plugins-base1.0-dev or libturbojpeg0-dev is missing (script/bootstrap installs them)")
  return()
endif()

# What knows no ROS.
add_library(saras_capture STATIC
  saras_ros1/nodelet/capture_source.cpp
  saras_ros1/nodelet/grabber.cpp
  saras_ros1/nodelet/jpeg.cpp
  saras_ros1/nodelet/picture.cpp)
set_target_properties(saras_capture PROPERTIES ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}")
target_include_directories(saras_capture PUBLIC saras_ros1/nodelet)
target_link_libraries(saras_capture PUBLIC saras::core PRIVATE PkgConfig::saras_gstreamer saras_compiler_options)

add_library(saras_endoscope_capture SHARED
  saras_ros1/nodelet/camera_file.cpp
  saras_ros1/nodelet/captured_eye.cpp
  saras_ros1/nodelet/endoscope_capture.cpp
  saras_ros1/nodelet/parameters.cpp)
target_link_libraries(saras_endoscope_capture PRIVATE saras_capture saras::core saras_compiler_options)
# GStreamer's types and threads outlive a nodelet that is unloaded: its code has to stay.
target_link_options(saras_endoscope_capture PRIVATE LINKER:-z,nodelete)
add_executable(saras_endoscope_capture_node saras_ros1/nodelet/endoscope_capture_main.cpp)
target_link_libraries(saras_endoscope_capture_node PRIVATE saras_compiler_options)
set_target_properties(saras_endoscope_capture_node PROPERTIES OUTPUT_NAME endoscope_capture
  RUNTIME_OUTPUT_DIRECTORY "${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION}")
set_target_properties(saras_endoscope_capture PROPERTIES LIBRARY_OUTPUT_DIRECTORY "${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_LIB_DESTINATION}")
foreach(target IN ITEMS saras_endoscope_capture saras_endoscope_capture_node)
  foreach(package IN LISTS saras_capture_packages)
    target_include_directories(${target} SYSTEM PRIVATE ${${package}_INCLUDE_DIRS})
    target_link_libraries(${target} PRIVATE ${${package}_LIBRARIES})
  endforeach()
endforeach()

install(TARGETS saras_endoscope_capture LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
install(TARGETS saras_endoscope_capture_node RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})

if(SARAS_BUILD_TESTS)
  file(GLOB saras_capture_tests CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/tests/cpp/capture/*.cpp")
  add_executable(test_capture ${saras_capture_tests})
  target_link_libraries(test_capture PRIVATE saras_capture PkgConfig::saras_gstreamer saras_compiler_options GTest::gtest_main)
  target_compile_options(test_capture PRIVATE -UNDEBUG)
  set_target_properties(test_capture PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/tests")
endif()
