# fish completion for clast: the program itself completes, from its option tables. Where it knows nothing, fish completes
# names of files.
# Use: clast completion fish > ~/.config/fish/completions/clast.fish
function __clast_words
  set -l before (commandline -opc)
  clast completion fish -- $before[2..-1] (commandline -ct) 2>/dev/null
end
complete -c clast -n 'test (count (__clast_words)) -gt 0' -f -a '(__clast_words)'
