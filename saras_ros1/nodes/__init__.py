"""One file a node; saras_ros1/scripts/ holds their executables."""
