# The ROS package saras_ros1: messages, Python nodes, launch files. Included last (see CMakeLists.txt).
find_package(catkin REQUIRED COMPONENTS message_generation std_msgs geometry_msgs sensor_msgs)
catkin_python_setup()

file(GLOB saras_msgs CONFIGURE_DEPENDS RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}/msg" "${CMAKE_CURRENT_SOURCE_DIR}/msg/*.msg")
file(GLOB saras_srvs CONFIGURE_DEPENDS RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}/srv" "${CMAKE_CURRENT_SOURCE_DIR}/srv/*.srv")
add_message_files(DIRECTORY msg FILES ${saras_msgs})
if(saras_srvs)
  add_service_files(DIRECTORY srv FILES ${saras_srvs})
endif()
generate_messages(DEPENDENCIES std_msgs geometry_msgs sensor_msgs)
catkin_package(CATKIN_DEPENDS message_runtime std_msgs geometry_msgs sensor_msgs)

include(SarasCrtkMsgs)

# Node sources stay not executable, or rosrun would find each of them twice.
file(GLOB saras_nodes CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/saras_ros1/scripts/*")
catkin_install_python(PROGRAMS ${saras_nodes} DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})

# xacro lives in the venv: put it on PATH of whoever sources devel/setup.bash.
catkin_add_env_hooks(50.saras SHELLS sh DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/cmake/env-hooks")

install(DIRECTORY launch urdf config DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
install(DIRECTORY bindings/saras DESTINATION ${CATKIN_PACKAGE_PYTHON_DESTINATION}/.. FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN "data/*")
install(TARGETS saras_ext LIBRARY DESTINATION ${CATKIN_PACKAGE_PYTHON_DESTINATION}/../saras)
