# Fails the build where a file of the core contains a word that the core must not contain.
# Comments and string literals are removed before the search, so that a header may explain what it does not do.

set(CORE_FOLDERS hal estimation control firmware/include firmware/src)
set(FORBIDDEN_WORDS
    new delete malloc calloc realloc free throw try catch dynamic_cast typeid double goto
    std::vector std::string std::map std::unordered_map std::set std::list std::deque std::function
    std::shared_ptr std::unique_ptr std::make_shared std::make_unique std::any std::thread std::mutex
    std::cout std::cerr printf MatrixXf MatrixXd VectorXf VectorXd Dynamic)

set(findings "")
foreach(folder IN LISTS CORE_FOLDERS)
    file(GLOB_RECURSE files ${SOURCE_DIR}/${folder}/*.hpp ${SOURCE_DIR}/${folder}/*.cpp ${SOURCE_DIR}/${folder}/*.h)
    foreach(file IN LISTS files)
        file(READ ${file} text)
        string(REPLACE ";" " " text "${text}")
        string(REPLACE "[" " " text "${text}")
        string(REPLACE "]" " " text "${text}")
        string(REGEX REPLACE "//[^\n]*" "" text "${text}")
        string(REGEX REPLACE "\"[^\"\n]*\"" "" text "${text}")
        string(REGEX REPLACE "= *(delete|default)" "" text "${text}")
        string(REPLACE "\n" ";" lines "${text}")
        set(line_number 0)
        foreach(line IN LISTS lines)
            math(EXPR line_number "${line_number} + 1")
            foreach(word IN LISTS FORBIDDEN_WORDS)
                if("${line}" MATCHES "(^|[^A-Za-z0-9_])${word}([^A-Za-z0-9_]|$)")
                    file(RELATIVE_PATH name ${SOURCE_DIR} ${file})
                    string(APPEND findings "  ${name}:${line_number}: '${word}' is forbidden in the core\n")
                endif()
            endforeach()
        endforeach()
    endforeach()
endforeach()

if(findings)
    message(FATAL_ERROR "The core allocates nothing, throws nothing and computes in its template scalar:\n${findings}")
endif()
