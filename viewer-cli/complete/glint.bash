# bash completion for glint: the program itself says what may stand at the cursor.
_glint() {
    local rest=${COMP_LINE:0:COMP_POINT} words=() word='' glued i text prefix full head path
    # bash splits words at = and :, too. What follows no space belongs to the word before.
    for ((i = 0; i <= COMP_CWORD; i++)); do
        glued=$((i > 0))
        while [[ $rest == [[:space:]]* ]]; do rest=${rest#?} glued=0; done
        word=${COMP_WORDS[i]}
        ((i < COMP_CWORD)) || word=$rest
        rest=${rest#"$word"}
        if ((glued)); then words[-1]+=$word; else words+=("$word"); fi
    done
    full=${words[-1]}
    head=${full%"${full##*[=:]}"} # bash keeps this part of the word
    COMPREPLY=()
    while IFS=$'\t' read -r text prefix; do
        case $text in
        :files | :folders)
            compopt -o filenames
            while IFS= read -r path; do
                path=$prefix$path
                COMPREPLY+=("${path#"$head"}")
            done < <(if [[ $text == :files ]]; then compgen -f -- "${full#"$prefix"}"; else compgen -d -- "${full#"$prefix"}"; fi)
            ;;
        *)
            COMPREPLY+=("${text#"$head"}")
            if [[ $text == *[=.:] ]]; then compopt -o nospace; fi
            ;;
        esac
    done < <(command "${words[0]}" --complete "${words[@]:1}" 2>/dev/null)
}
complete -F _glint glint
