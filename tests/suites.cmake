# Read by ctest before it tests: one test a suite of each program of SUITE_PROGRAMS, "PREFIX|PROGRAM|FILTER" each,
# of those suites that GoogleTest's filter lets through.
# The tests of a suite share its process, and with it the device's pipelines, whose making costs most tests of
# sensors more than what they draw. They begin before single tests, which fill the gaps at the end.
foreach(entry ${SUITE_PROGRAMS})
  string(REGEX MATCH "^(.*)\\|(.*)\\|(.*)$" entry "${entry}")
  set(prefix ${CMAKE_MATCH_1})
  set(program ${CMAKE_MATCH_2})
  set(filter ${CMAKE_MATCH_3})
  if(NOT EXISTS ${program})
    add_test(${prefix}_NOT_BUILT ${program})
    continue()
  endif()
  execute_process(COMMAND ${program} --gtest_list_tests --gtest_filter=${filter} OUTPUT_VARIABLE listed RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${program} --gtest_list_tests: status ${status}")
  endif()
  string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+\\." suites "${listed}")
  foreach(suite ${suites})
    string(REGEX REPLACE "[\n.]" "" suite "${suite}")
    add_test(${prefix}.${suite} ${program} "--gtest_filter=${suite}.*" --gtest_color=no)
    set_tests_properties(${prefix}.${suite} PROPERTIES TIMEOUT 900 COST 10
      SKIP_REGULAR_EXPRESSION "PASSED  \\] 0 tests\\.\n(\\[  SKIPPED \\][^\n]*\n?)+$")
  endforeach()
endforeach()
