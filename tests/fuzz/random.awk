# Random numbers that are the same with every awk: rand() is not. Park and Miller's generator; below 2**47, so exact.

# begin_random(seed, number): the numbers of the number-th mutant, whatever was made before it.
function begin_random(seed, number, k) {
   state = (seed*7919 + number*104729)%2147483646 + 1
   # Not linear, so that neighbours have nothing in common.
   for (k = 0; k < 5; k++) state = (state*16807 + int(state/4096)*69621)%2147483646 + 1
}

# random(n): 0 to n - 1
function random(n) {
   state = state*16807%2147483647
   return int(state/2147483647*n)
}

# one_of(list, n): one of list[1] to list[n]
function one_of(list, n) {
   return list[1 + random(n)]
}

# repeated(text, n): the text n times
function repeated(text, n, all) {
   all = ""
   while (n > 0) {
      if (n%2 == 1) all = all text
      text = text text
      n = int(n/2)
   }
   return all
}

# The numbers and words that programs do not like.
function list_odd_values() {
   odd_number[++odd_numbers] = "1e400"; odd_number[++odd_numbers] = "-1e400"; odd_number[++odd_numbers] = "1e-400"
   odd_number[++odd_numbers] = "nan"; odd_number[++odd_numbers] = "inf"; odd_number[++odd_numbers] = "-infinity"
   odd_number[++odd_numbers] = "-1"; odd_number[++odd_numbers] = "0"; odd_number[++odd_numbers] = "-0.0"
   odd_number[++odd_numbers] = "1e-300"; odd_number[++odd_numbers] = "1e300"; odd_number[++odd_numbers] = "1e30"
   odd_number[++odd_numbers] = "-1e30"; odd_number[++odd_numbers] = "4.9e-324"; odd_number[++odd_numbers] = "1e-9"
   odd_number[++odd_numbers] = "2147483647"; odd_number[++odd_numbers] = "2147483648"; odd_number[++odd_numbers] = "-2147483649"
   odd_number[++odd_numbers] = "9223372036854775808"; odd_number[++odd_numbers] = "0.5"; odd_number[++odd_numbers] = "1"
   odd_number[++odd_numbers] = "2.5"; odd_number[++odd_numbers] = "7"; odd_number[++odd_numbers] = "40"
   odd_number[++odd_numbers] = "1000"; odd_number[++odd_numbers] = "1d0"; odd_number[++odd_numbers] = "1e"
   odd_number[++odd_numbers] = "1.2.3"; odd_number[++odd_numbers] = "--1"; odd_number[++odd_numbers] = "0x10"
   odd_number[++odd_numbers] = "3*1.0"; odd_number[++odd_numbers] = "1,5"; odd_number[++odd_numbers] = "(1,2)"
   odd_number[++odd_numbers] = "1e99999999999"; odd_number[++odd_numbers] = "0.1, 0.2, 0.3, 0.4, 0.5"; odd_number[++odd_numbers] = ""
   odd_word[++odd_words] = "'"; odd_word[++odd_words] = "''"; odd_word[++odd_words] = "'never'"
   odd_word[++odd_words] = "'1 steps'"; odd_word[++odd_words] = "'0 steps'"; odd_word[++odd_words] = "'1e-300 time'"
   odd_word[++odd_words] = "'1e300 time'"; odd_word[++odd_words] = "'2147483648 steps'"; odd_word[++odd_words] = "'nan time'"
   odd_word[++odd_words] = "'1 minutes'"; odd_word[++odd_words] = "'/'"; odd_word[++odd_words] = "'&scene'"
   odd_word[++odd_words] = ".true."; odd_word[++odd_words] = "F"; odd_word[++odd_words] = "'auto'"
   odd_word[++odd_words] = "'\303\244\342\202\254'"; odd_word[++odd_words] = "*"; odd_word[++odd_words] = "\"x\""
}
