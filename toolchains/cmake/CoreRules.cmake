# SPDX-License-Identifier: Apache-2.0
# Fails the build where a file of the core contains a word that the core must not contain.
# Comments, string and character literals are removed before the search, so that a header may explain what it does not
# do; `= delete` and includes are no use of the word. `double` is forbidden, a literal like 0.5L is not.
cmake_minimum_required(VERSION 3.25)

set(CORE_FOLDERS hal estimation control firmware/include firmware/src firmware/can firmware/link drivers)
# Host code inside a folder of the core: not searched, and the core must not include its headers.
set(HOST_FOLDERS estimation/calibration)
set(host_header "^ *# *include *[<\"]estimation_calibration/")
set(FORBIDDEN_WORDS
    new delete malloc calloc realloc free alloca throw try catch dynamic_cast typeid double goto
    std::vector std::string std::map std::unordered_map std::set std::list std::deque std::function
    std::shared_ptr std::unique_ptr std::make_shared std::make_unique std::any std::thread std::mutex
    std::cout std::cerr printf MatrixXf MatrixXd VectorXf VectorXd Dynamic)
string(JOIN "|" any_forbidden_word ${FORBIDDEN_WORDS})
set(not_of_a_word "[^A-Za-z0-9_]")

# The file's lines as a list. Backslashes, brackets and semicolons have meaning in a CMake list and none for the search.
function(read_lines file result)
    file(READ "${file}" text)
    string(REPLACE "\\\\" " " text "${text}")
    string(REPLACE "\\\"" " " text "${text}")
    string(REPLACE "\\'" " " text "${text}")
    string(REGEX REPLACE "[][;\\\\]" " " text "${text}")
    string(REPLACE "\n" ";" lines "${text}")
    set(${result} "${lines}" PARENT_SCOPE)
endfunction()

# What is code in a line. `in_comment` says whether a block comment is open before, and is set for after.
macro(code_of_line line in_comment result)
    set(code "${line}")
    if(${in_comment})
        string(FIND "${code}" "*/" end)
        if(end EQUAL -1)
            set(code "")
        else()
            math(EXPR end "${end} + 2")
            string(SUBSTRING "${code}" ${end} -1 code)
            set(${in_comment} FALSE)
        endif()
    endif()
    # The leftmost match wins: a comment sign in a literal is no comment, a quote in a comment is no literal.
    string(REGEX REPLACE "\"[^\"]*\"|'[^']'|'  '|//.*|/[*]([^*]|[*]+[^*/])*[*]+/" " " code "${code}")
    string(FIND "${code}" "/*" begin)
    if(NOT begin EQUAL -1)
        string(SUBSTRING "${code}" 0 ${begin} code)
        set(${in_comment} TRUE)
    endif()
    string(REGEX REPLACE "= *delete( |$)" " " code "${code}")
    string(REGEX REPLACE "^ *# *include.*" " " code "${code}")
    set(${result} " ${code} ")
endmacro()

function(search_file file name)
    read_lines("${file}" lines)
    set(line_number 0)
    set(in_comment FALSE)
    set(found "")
    foreach(line IN LISTS lines)
        math(EXPR line_number "${line_number} + 1")
        if("${line}" MATCHES "${host_header}")
            string(APPEND found "  ${name}:${line_number}: a header of the host is forbidden in the core\n")
        endif()
        code_of_line("${line}" in_comment code)
        if(NOT "${code}" MATCHES "${not_of_a_word}(${any_forbidden_word})${not_of_a_word}")
            continue()
        endif()
        foreach(word IN LISTS FORBIDDEN_WORDS)
            if("${code}" MATCHES "${not_of_a_word}${word}${not_of_a_word}")
                string(APPEND found "  ${name}:${line_number}: '${word}' is forbidden in the core\n")
            endif()
        endforeach()
    endforeach()
    set(findings "${findings}${found}" PARENT_SCOPE)
endfunction()

set(findings "")
foreach(folder IN LISTS CORE_FOLDERS)
    file(GLOB_RECURSE files RELATIVE "${SOURCE_DIR}"
        "${SOURCE_DIR}/${folder}/*.hpp" "${SOURCE_DIR}/${folder}/*.cpp" "${SOURCE_DIR}/${folder}/*.h")
    foreach(host_folder IN LISTS HOST_FOLDERS)
        list(FILTER files EXCLUDE REGEX "^${host_folder}/")
    endforeach()
    foreach(name IN LISTS files)
        search_file("${SOURCE_DIR}/${name}" "${name}")
    endforeach()
endforeach()

if(findings)
    message(FATAL_ERROR "The core allocates nothing, throws nothing and computes in its template scalar:\n${findings}")
endif()
