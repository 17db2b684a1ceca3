target_link_libraries(${target} PRIVATE pugixml::pugixml PNG::PNG)
