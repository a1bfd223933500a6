# Completion of aspic and aspic-view for fish.
function __aspic_complete
    set -l words (commandline -opc) (commandline -ct)
    set -l start (string replace -r -- '^--[^=]*=' '' $words[-1])
    set -l program (string replace -r 'aspic-view$' aspic -- $words[1])
    for line in ($program --complete $words 2>/dev/null)
        switch $line
            case ':directory*'
                __fish_complete_directories $start
            case ':file*'
                __fish_complete_path $start
            case ':toml*'
                __fish_complete_suffix .toml
            case '*'
                echo $line
        end
    end
end
complete -c aspic -f -a '(__aspic_complete)'
complete -c aspic-view -f -a '(__aspic_complete)'
