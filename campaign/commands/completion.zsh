#compdef clast
# zsh completion for clast: the program itself completes, from its option tables. Where it knows nothing, zsh completes
# names of files.
# Use: put it as _clast into a folder of $fpath.
local -a found
found=("${(@f)$(clast completion zsh -- "${(@)words[2,CURRENT]}" 2>/dev/null)}")
if [[ -z $found ]]; then
  _files
elif [[ $found[1] == *= ]]; then
  compadd -S '' -a found
else
  _describe clast found
fi
