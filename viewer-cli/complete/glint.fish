# fish completion for glint: the program itself says what may stand at the cursor.
function __glint_complete
    set -l words (commandline -opc)
    set -l word (commandline -ct)
    for line in (command $words[1] --complete $words[2..] "$word" 2>/dev/null)
        set -l parts (string split -m 1 \t -- $line)
        switch $parts[1]
            case :files
                set -l length (string length -- "$parts[2]")
                for path in (__fish_complete_path (string sub -s (math $length + 1) -- "$word"))
                    printf '%s%s\n' "$parts[2]" $path
                end
            case :folders
                set -l length (string length -- "$parts[2]")
                for path in (__fish_complete_directories (string sub -s (math $length + 1) -- "$word"))
                    printf '%s%s\n' "$parts[2]" $path
                end
            case '*'
                printf '%s\n' $line
        end
    end
end
complete -c glint -f -a '(__glint_complete)'
