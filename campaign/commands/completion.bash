# bash completion for clast: the program itself completes, from its option tables. Where it knows nothing, bash completes
# names of files.
# Use: source <(clast completion bash)
_clast() {
  local IFS=$'\n'
  COMPREPLY=($(clast completion bash -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null))
  [[ ${COMPREPLY[0]} != *= ]] || compopt -o nospace 2>/dev/null
}
complete -o default -F _clast clast
