# Writes mutants of scenes.
#
#    dynsph --keys | LC_ALL=C awk -v seed=1 -v first=1 -v count=500 -v into=DIR -f random.awk -f mutate_scene.awk - SCENE.nml...
#
# Mutant number i is DIR/i.nml, the same for any count. Prints for each: number, what it must be, what was done.
#
#    any       right or refused
#    refused   it has an unknown or a repeated key
#    nul       any; each byte 1 in the file shall be a byte 0, which awk cannot write

FNR == 1 { n_files++ }

# The list of keys: names of groups, of keys, and what they can be.
n_files == 1 && /^## &/ {
   listed_group = substr($2, 2)
   group[++groups] = listed_group
   word[++words] = "&" listed_group
}
n_files == 1 && /^\| `/ {
   split($0, cell, "|")
   gsub(/[ `]/, "", cell[2])
   key[++keys] = cell[2]
   group_of[keys] = listed_group
   belongs[listed_group, cell[2]] = 1
   word[++words] = cell[2]
   is_text[keys] = cell[3] ~ /'/
   numbers[keys] = 1 + gsub(/,/, ",", cell[3])
   if (cell[3] ~ /required/ && cell[2] ~ /lower|upper|position/) numbers[keys] = 2
   choices[keys] = 0
   rest = cell[5]
   while (match(rest, /'[^']*'/)) {
      choice[keys, ++choices[keys]] = substr(rest, RSTART, RLENGTH)
      word[++words] = substr(rest, RSTART, RLENGTH)
      rest = substr(rest, RSTART + RLENGTH)
   }
}
n_files > 1 { text[n_files - 1] = text[n_files - 1] $0 "\n" }

END {
   list_odd_values()
   for (k = 1; k <= odd_numbers; k++) word[++words] = odd_number[k]
   for (k = 1; k <= odd_words; k++) word[++words] = odd_word[k]
   junk_list = "' \" / & ! = , ( ) ; % \001 \t \r \n \\ \177 \303\244 \377 \342\202 \357\273\277 /\n &body\n 'a''b' !' $ {} *"
   junks = split(junk_list, junk, " ")
   for (i = first; i < first + count; i++) {
      begin_random(seed, i)
      scene = text[1 + random(n_files - 1)]
      must_be = "any"
      done = ""
      kind = random(10)
      # Keys are looked for in scenes that are right but for them.
      if (kind < 2) {
         scene = (kind == 0) ? with_unknown_key(scene) : with_repeated_key(scene)
      } else if (kind < 6) {
         for (k = 1 + random(3); k > 0; k--) scene = with_value(scene, 1 + random(keys))
      } else {
         for (k = random(3) ? 1 : 2 + random(3); k > 0; k--) scene = mutated(scene)
      }
      if (must_be == "any" && index(scene, "\001")) must_be = "nul"
      path = into "/" i ".nml"
      printf "%s", scene > path
      close(path)
      print i, must_be, done
   }
}

function mutated(scene, kind, at, n) {
   kind = random(18)
   at = 1 + random(length(scene))
   done = done " " kind
   if (kind == 0) return substr(scene, 1, at - 1) substr(scene, at + 1 + random(20))
   if (kind == 1) return substr(scene, 1, at - 1) one_of(junk, junks) substr(scene, at)
   if (kind == 2) return substr(scene, 1, at - 1) sprintf("%c", 1 + random(255)) substr(scene, at + 1)
   if (kind == 3) return substr(scene, 1, at)
   if (kind == 4) return replaced(scene, at, "[A-Za-z_]+", one_of(word, words))
   if (kind == 5) return replaced(scene, at, "'[^'\n]*'", one_of(word, words))
   if (kind == 6 || kind == 7) return replaced(scene, at, "-?[0-9][0-9.]*", one_of(odd_number, odd_numbers))
   if (kind == 8) return replaced(scene, at, "\n[^\n]*\n", "\n")
   if (kind == 9) return with_line_twice(scene, at)
   if (kind == 10) return with_group(scene, text[1 + random(n_files - 1)])
   if (kind == 11) return substr(scene, 1, at) repeated(one_of(junk, junks) "x", 100 + random(20000)) substr(scene, at)
   if (kind == 12) return with_group(scene, scene repeated(block(scene), 1 + random(60)))
   return with_value(scene, 1 + random(keys))
}

# replaced(scene, at, pattern, new): the first match behind a place; the scene as it is where there is none
function replaced(scene, at, pattern, new, tail) {
   tail = substr(scene, at)
   if (!match(tail, pattern)) return scene
   return substr(scene, 1, at - 1) substr(tail, 1, RSTART - 1) new substr(tail, RSTART + RLENGTH)
}

function with_line_twice(scene, at, tail) {
   tail = substr(scene, at)
   if (!match(tail, /\n[^\n]*\n/)) return scene
   return substr(scene, 1, at + RSTART + RLENGTH - 2) substr(tail, RSTART + 1)
}

# block(scene): one of its groups, as a text
function block(scene, tail) {
   tail = substr(scene, 1 + random(length(scene)))
   if (!match(tail, /&[a-z]+[^\/]*\//)) return "&body\n/\n"
   return substr(tail, RSTART, RLENGTH) "\n"
}

function with_group(scene, other) {
   return random(2) ? scene block(other) : block(other) scene
}

# with_value(scene, k): the k-th key at another value, in its group; often of the kind that it takes
function with_value(scene, k, value, n) {
   if (random(6) == 0) value = one_of(word, words)
   else if (choices[k] > 0) value = choice[k, 1 + random(choices[k])]
   else if (is_text[k]) value = one_of(odd_word, odd_words)
   else {
      value = some_number()
      for (n = numbers[k]; n > 1; n--) value = value ", " some_number()
   }
   done = done " " group_of[k] "." key[k] "=" value
   return in_group(without_key(scene, group_of[k], key[k]), group_of[k], key[k] " = " value)
}

function some_number() {
   if (random(3) == 0) return one_of(odd_number, odd_numbers)
   return (random(6) ? "" : "-") (1 + random(99)) "e" (random(9) - 5)
}

# The scene without the first line of a key in the first group of that name
function without_key(scene, name, key_name, start, tail) {
   start = index(scene, "&" name "\n")
   if (start == 0) return scene
   tail = substr(scene, start)
   if (!match(tail, "\n *" key_name " *=[^\n]*\n")) return scene
   return substr(scene, 1, start - 1) substr(tail, 1, RSTART) substr(tail, RSTART + RLENGTH)
}

# A line at the start of a group, which is appended if there is none.
function in_group(scene, name, line, start) {
   start = index(scene, "&" name "\n")
   if (start == 0) return scene "&" name "\n   " line "\n/\n"
   start = start + length(name)
   return substr(scene, 1, start) "\n   " line substr(scene, start + 1)
}

# The key of another group, or letters, in a group that the scene has.
function with_unknown_key(scene, name, unknown, k) {
   name = group_in(scene)
   k = 1 + random(keys)
   unknown = key[k]
   if (random(2)) unknown = substr(unknown, 1, random(length(unknown))) "q" substr(unknown, 1, 20)
   if ((name, unknown) in belongs) unknown = unknown "q"
   must_be = "refused"
   done = " unknown " name "." unknown
   return in_group(scene, name, unknown " = " (random(2) ? "1.0" : "'never'"))
}

# A key that a group has already, once more.
function with_repeated_key(scene, name, tail, line) {
   name = group_in(scene)
   tail = substr(scene, index(scene, "&" name "\n"))
   tail = substr(tail, 1, index(tail, "\n/"))
   if (!match(tail, /\n *[a-z_]+ *= *[^\n]*/)) return with_unknown_key(scene)
   line = substr(tail, RSTART + 1, RLENGTH - 1)
   sub(/^ */, "", line)
   if (random(2)) line = toupper(substr(line, 1, index(line, "=") - 1)) substr(line, index(line, "="))
   must_be = "refused"
   done = " repeated " name "." line
   return in_group(scene, name, line)
}

function group_in(scene, k, name) {
   for (k = 0; k < 100; k++) {
      name = one_of(group, groups)
      if (index(scene, "&" name "\n")) return name
   }
   return "scene"
}
