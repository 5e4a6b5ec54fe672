# One interpreter for bindings, catkin and pybind11. pybind11 comes from PyPI: Debian's 2.10 reads
# numpy 2 arrays with itemsize 0 without saying so.
if(PYTHON_EXECUTABLE)
  set(Python_EXECUTABLE "${PYTHON_EXECUTABLE}" CACHE FILEPATH "" FORCE)
  set(Python3_EXECUTABLE "${PYTHON_EXECUTABLE}" CACHE FILEPATH "" FORCE)
endif()
find_package(Python 3.9 REQUIRED COMPONENTS Interpreter Development.Module)
set(PYTHON_EXECUTABLE "${Python_EXECUTABLE}" CACHE FILEPATH "" FORCE)
set(PYBIND11_FINDPYTHON ON)
execute_process(
  COMMAND "${Python_EXECUTABLE}" -c "import pybind11; print(pybind11.get_cmake_dir())"
  OUTPUT_VARIABLE saras_pybind11_dir OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
find_package(pybind11 3.0 CONFIG HINTS "${saras_pybind11_dir}")
if(NOT pybind11_FOUND)
  message(FATAL_ERROR "pybind11 >= 3.0 is missing for ${Python_EXECUTABLE}. Run script/bootstrap, or: pip install 'pybind11==3.1.0'")
endif()
