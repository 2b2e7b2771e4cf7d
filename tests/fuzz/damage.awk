# Says how files are damaged: a line for each mutant: number, what is damaged, how, and where.
#
#    awk -v seed=1 -v first=1 -v count=100 -v "sizes=snapshot 19032 probes 4000 checkpoint 25696 table 20000"
#       -f random.awk -f damage.awk
#
#    flip BYTE BIT...   bits are changed, BYTE from 0 on
#    zero BYTE N        N bytes are 0
#    cut N              N bytes are left
#    grow N             N bytes are added
#    foreign NAME       it is another file

BEGIN {
   n = split(sizes, word, " ")
   for (k = 1; k < n; k += 2) size[word[k]] = word[k + 1]
   targets = split("text text vorticity probe probe one both both table", target, " ")
   file["text"] = "snapshot"; file["vorticity"] = "snapshot"; file["probe"] = "probes"; file["table"] = "table"
   file["one"] = "checkpoint"; file["both"] = "checkpoint"
   strangers = split("empty words snapshot checkpoint directory nothing dangling", stranger, " ")
   for (i = first; i < first + count; i++) {
      begin_random(seed, i)
      chosen = target[1 + random(targets)]
      line = i " " chosen " " damage(size[file[chosen]])
      if (file[chosen] == "snapshot") sub(/foreign snapshot/, "foreign checkpoint", line)   # a snapshot would be read, and rightly
      print line
   }
}

function damage(size, kind, k, all) {
   kind = random(20)
   if (kind < 11) {
      all = "flip"
      for (k = random(3) ? 1 : 1 + random(10); k > 0; k--) all = all " " random(size) " " random(8)
      return all
   }
   if (kind < 14) return "zero " random(size) " " 1 + random(600)
   if (kind < 17) return "cut " random(size)
   if (kind < 18) return "grow " 1 + random(5000)
   return "foreign " stranger[1 + random(strangers)]
}
